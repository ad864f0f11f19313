// Who reads what of an image where no tick of the shipped scenes does. Everything else in an image is read by some tick
// of its scene: tests/gates/unread_data.cpp measures it, and checks that the readers named here name what they read.
#pragma once

namespace palpate {

// X(array or parameter, reader): the host, and the loop around the tick.
#define PALPATE_HOST_READERS(X)                                \
  X(vertex_normal, "sim_host/view/surface_shape.cpp")          \
  X(triangle, "sim_host/view/deformed_surface.cpp")            \
  X(patch, "sim_host/view/surface_shape.cpp")                  \
  X(anchor, "sim_host/view/anchors.cpp")                       \
  X(rbf_inverse, "sim_host/view/rbf_surface.cpp")              \
  X(beam_stiffness, "rt_core/skeleton/beam_table.cpp")         \
  X(beam_ratio, "rt_core/skeleton/beam_table.cpp")             \
  X(beam_response, "sim_host/view/anchors.cpp")                \
  X(skeleton_law, "sim_host/view/anchors.cpp")                 \
  X(shape_law, "sim_host/view/surface_shape.cpp")              \
  X(rbf_tail, "rt_core/skeleton/rbf.cpp")                      \
  X(neighbourhood_law, "sim_host/view/surface_shape.cpp")      \
  X(neighbourhood_radius_m, "sim_host/view/surface_shape.cpp") \
  X(surface_size_m, "sim_host/view/rbf_surface.cpp")           \
  X(stage_cost, "rt_core/stage_cost.cpp")                      \
  X(palm_radius_m, "sim_host/press/grasp_stability.cpp")       \
  X(palm_face_m, "sim_host/press/grasp_stability.cpp")         \
  X(late_ticks_max, "hal/loop/loop.h")                         \
  X(stall_max_s, "hal/loop/loop.h")

// X(array or parameter, reader, when): in the tick, but not in every scene that the gate plays.
#define PALPATE_RARE_READERS(X)                                                                    \
  X(grip_x_m, "rt_core/tool/held_body.h", "a hand holds the body (device.holds)")                  \
  X(grip_y_m, "rt_core/tool/held_body.h", "a hand holds the body (device.holds)")                  \
  X(grip_z_m, "rt_core/tool/held_body.h", "a hand holds the body (device.holds)")                  \
  X(response_root, "rt_core/contact/tips/tip_law.cpp", "tables of responses, which users bake")    \
  X(factor, "rt_core/contact/tips/tip_law.cpp", "a tip is no line: a ball, or on no elastic body") \
  X(wall_N_per_m, "rt_core/contact/nodes/gather.cpp", "a node that the body holds is pushed")

struct DataReader {
  const char* name;
  const char* reader;  // path in the sources
  const char* when;    // "" for the host
};
inline constexpr DataReader kDataReaders[] = {
#define PALPATE_ENTRY(name, reader) {#name, reader, ""},
    PALPATE_HOST_READERS(PALPATE_ENTRY)
#undef PALPATE_ENTRY
#define PALPATE_ENTRY(name, reader, when) {#name, reader, when},
        PALPATE_RARE_READERS(PALPATE_ENTRY)
#undef PALPATE_ENTRY
};

}  // namespace palpate
