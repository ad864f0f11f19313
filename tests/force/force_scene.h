// A synthetic model, state and scratch for the contact stage: contacts are placed by hand, no mesh is needed.
#pragma once

#include <cstring>
#include <memory>

#include "rt_core/contact/contact.h"
#include "tests/support/roomy.h"

namespace palpate {

struct ForceScene {
  Model model;
  StatePtr state = test::roomy_state();
  ScratchPtr scratch = test::roomy_scratch();

  ForceScene() {
    test::poison(*scratch, test::roomiest_model(), 0xAB);  // nothing may depend on old scratch
    ModelParams& p = model.params;
    p = {};
    p.contact_weight = ContactWeight::kWinkler;
    p.friction_law = FrictionLaw::kReturnMap;
    p.tangential_law = TangentialLaw::kSeparable;
    p.coupling_law = CouplingLaw::kNone;
    p.period_s = 1e-3;
    p.k1_N_per_m = 40;  // the paper's coefficients (Luo & Xiao 2006), read as N and mm
    p.k3_N_per_m3 = 3e8;
    p.max_depth_m = 0.02;
    p.friction_k_N = 0.8 * 1.4953487812212205;  // 0.8 * 5^0.25: f_max = 4 N at 5 N
    p.friction_beta = 0.75;
    p.friction_mu_dynamic = 0.5;
    p.youngs_modulus_Pa = 3e6;
    p.poisson_ratio = 0.47;
    p.far_field_radius_m = 0.01;
    p.surface_size_m = 0.1;
    p.coupling_N_per_m = 1000;
    p.coupling_Nm_per_rad = 1;
    reset_state();
    clear_contacts();
  }

  void reset_state() { reset(*state); }
  void clear_contacts() {
    scratch->contact_count = 0;
    scratch->status = 0;
  }
  void set_coupling(CouplingLaw law) { model.params.coupling_law = law; }
  void set_friction(FrictionLaw law) { model.params.friction_law = law; }

  // Opens region `slot` as find_rows would.
  Region& open_region(std::int32_t slot, std::uint32_t id, std::uint32_t born_tick = 0) {
    Region& region = state->region[slot];
    region = Region{};
    region.id = id;
    region.born_tick = born_tick;
    return region;
  }
  Contact& add_contact(std::int32_t slot, Vec3 position, Vec3 normal, double depth, double weight = 1.0) {
    Contact& contact = scratch->contact[scratch->contact_count];
    contact = Contact{};
    contact.row = contact.point = scratch->contact_count++;
    contact.region = slot;
    contact.position_w = position;
    contact.normal_w = normal;
    contact.depth_m = depth;
    contact.weight = weight;
    return contact;
  }
  void run() {
    scratch->driven = 0;
    clear_contact(*state, *scratch);
    points_method.solve(model, *state, *scratch);
    points_method.account(model, *state, *scratch);
  }
  // Moves the tool; the next run sees the step from the present pose.
  void move_tool(Pose pose) {
    state->tool_previous_w = state->tool_w;
    state->tool_w = pose;
  }
  Vec3 force() const { return scratch->contact_wrench_w.force_N; }
  Vec3 torque() const { return scratch->contact_wrench_w.torque_Nm; }
};

}  // namespace palpate
