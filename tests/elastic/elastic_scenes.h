// Bodies that the elastic body is measured on, each with its large-strain reference. SI units.
#pragma once

#include <memory>

#include "config/elastic/static_contact.h"
#include "tests/strain/plane_scenes.h"

namespace palpate::elastic {

// A supported body with the nodes that tools may touch.
template <int kDim>
struct ElasticScene {
  fem::StrainMesh<kDim> mesh;
  fem::StrainBody material;
  std::vector<bool> fixed;
  std::vector<int> contact_nodes;
};

// F: the half clip of plane_scenes.h. Reference: ClipOnTube.
ElasticScene<2> clip_scene(double element_m);
// D: the whole ring; its two axes of symmetry stay straight. Reference: RingBetweenPlates.
ElasticScene<2> plates_scene(int elements_around);
// G2: the clamped ring. Reference: RingUnderFingers.
ElasticScene<2> fingers_scene(double contact_element_m, double inner_m = 0.020);
// Origin of finger 0 (90 degrees) or 1 (20 degrees) pressed in by `depth_m`; and the inward force it feels.
fem::Point<2> finger_origin(int finger, double depth_m);
double finger_force_N(int finger, const StaticState<2>& state);

// A: the rubber block of strain_scenes.h as tetrahedra, its top at y = 0. Reference: press_axisymmetric.
ElasticScene<3> block_scene();
// A tongue of 40 x 4 x 10 mm along x, held at x = 0, pressed from above near its free end.
inline constexpr double kTongueLength_m = 0.040, kTongueThickness_m = 0.004, kTonguePlace_m = 0.035;
ElasticScene<3> tongue_scene(double thickness_m = kTongueThickness_m);

// A rest body and what is made of it, kept together.
template <int kDim>
struct BakedBody {
  BakedBody(const ElasticScene<kDim>& scene, const ElasticOptions& options)
      : rest(std::make_unique<RestBody<kDim>>(scene.mesh, scene.material, scene.fixed)),
        body(make_elastic_body(*rest, scene.contact_nodes, options)) {}
  std::unique_ptr<RestBody<kDim>> rest;
  ElasticBody<kDim> body;
};

}  // namespace palpate::elastic
