// Worked numbers of Cui & Xiao 2008: the hand of Table I and its joints, the surface between the anchors, the
// logarithmic neighbourhood, contacts that lean on one another.
#include <array>
#include <vector>

#include "config/hand/hand_model.h"
#include "rt_core/contact/points/point_laws.h"
#include "rt_core/contact/region_solve.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/view/neighbourhood.h"
#include "sim_host/view/rbf_surface.h"
#include "tests/deform/deform_scene.h"
#include "tests/published/worked.h"

namespace palpate::test {
namespace {

// Width, length and radius of the local neighbourhood, mm. The labels of the printed rows are slipped by one: 13 to 15
// are the thumb's.
TEST(CuiXiao2008, TableOne) {
  const double rows[kHandParts][3] = {{12, 25.1, 10}, {12, 21.5, 10}, {12, 26.9, 10}, {15, 27.2, 12}, {16, 24.3, 13},
                                      {17, 30.3, 14}, {12, 25.2, 10}, {12, 20.9, 10}, {12, 27.2, 10}, {8, 18.9, 7},
                                      {9, 15.6, 7},   {10, 16.8, 8},  {15, 26.9, 18}, {14, 33.5, 13}, {14, 38.9, 10}};
  for (std::size_t i = 0; i < kHandParts; ++i) {
    const HandPart& part = hand_parts()[i];
    expect_worked(1e3 * part.width_m, rows[i][0], part.name);
    expect_worked(1e3 * part.length_m, rows[i][1], part.name);
    expect_worked(1e3 * part.neighbourhood_radius_m, rows[i][2], part.name);
  }
}

std::vector<Vec3> places_mm(const std::vector<Joint>& chain, const std::vector<double>& degrees) {
  Model model;
  model.joint = chain;
  std::vector<double> q;
  for (const double d : degrees) q.push_back(d * kPi / 180);
  Pose link[kMaxJoints];
  place_links(model, q.data(), link, nullptr, nullptr);
  std::vector<Vec3> at;
  for (std::size_t j = 0; j < chain.size(); ++j) at.push_back(1e3 * link[j].position_m);
  return at;
}

TEST(CuiXiao2008, JointsOfFingerAndThumb) {
  const std::vector<Vec3> finger = places_mm(finger_chain({}, {0.0269, 0.0215, 0.0251}, 0, 1, 1), {10, 40, 50, 30});
  expect_worked(finger[1], {20.29353503118465, 3.578297759950255, -17.29098670056791});
  expect_worked(finger[2], {20.29353503118465, 3.578297759950255, -38.79098670056791});
  expect_worked(finger[3], {7.934197730881443, 1.399013130230279, -60.52822433555732});
  const std::vector<Vec3> thumb = places_mm(thumb_chain({}, {0.0389, 0.0335, 0.0269}, 1), {20, 15, 5, 30, 25});
  expect_worked(thumb[1], {35.30849413930534, 12.8512408834698, -10.06806085448806});
  expect_worked(thumb[3], {56.60298452143831, 23.29262763083142, -33.72756469876314});
  expect_worked(thumb[4], {64.73525632932664, 27.68357909621254, -58.9901002102927});
}

// Six anchors of an ellipsoid, a dent at (20, 15, 17.6776695) mm, phi(r) = r with a constant and a linear tail; x at
// (10, -20, 15) mm.
TEST(CuiXiao2008, SurfaceBetweenTheAnchors) {
  const Vec3 moved[6] = {{2e-3, 0, -4e-3}, {-2e-3, 0, -4e-3}, {0, 2e-3, -5e-3}, {0, -2e-3, -5e-3}, {0, 0, -35e-3}, {}};
  const Vec3 p{20e-3, 15e-3, 17.6776695e-3}, dent{1e-3, 2e-3, -20e-3}, x{10e-3, -20e-3, 15e-3};
  const struct {
    RbfTail tail;
    double weight[6], dent_weight;
    Vec3 moved_mm;
  } rows[] = {{RbfTail::kConstant,
               {0.1862227662587834, -0.02440787196573502, -0.04360370958230148, 0.4986496393441143, 0.4048781831898356,
                -0.02173900724469676},
               0.07532005643940856,
               {0.4331151848258813, -0.9883543743172082, -17.25974472375394}},
              {RbfTail::kLinear,
               {0.2059074471465242, -0.04409255285347583, -0.1058103684524269, 0.5608562982142397, 0.4915695879725694,
                -0.1084304120274306},
               0.09148657223733667,
               {0.5, -1.241846761095997, -19.9472129258612}}};
  for (const auto& row : rows) {
    deform_test::Scene scene;
    scene.model.params.rbf_tail = row.tail;
    deform_test::make_ellipsoid(scene);
    RbfVector weight{}, at_x{}, at_p{};
    rbf_weights(scene.model, x, weight);
    for (std::size_t i = 0; i < 6; ++i) expect_worked(weight[i], row.weight[i]);
    RbfContact contact;
    make_rbf_contact(scene.model, p, contact);
    Vec3 c[kMaxRbf];
    rbf_coefficients(scene.model, moved, c);
    rbf_terms(scene.model, x, at_x);
    rbf_terms(scene.model, p, at_p);
    const double psi = rbf_contact_weight(scene.model, contact, at_x, x);
    expect_worked(psi, row.dent_weight);
    expect_worked(1e3 * (rbf_value(scene.model, at_x, c) + psi * (dent - rbf_value(scene.model, at_p, c))),
                  row.moved_mm);
  }
}

// "A logarithmic function of the distance to the contact region": 3 to 10 mm, 4.3577 mm in the dent, 0.8 mm outside.
TEST(CuiXiao2008, LogarithmicNeighbourhood) {
  const LogLaw law = log_law(3e-3, 10e-3, 4.3577e-3, 0.8e-3);
  expect_worked(law.b, 2.954967078340143e-3);
  expect_worked(law.a, -1.280812628974836e-2);
  expect_worked(law.a - law.b * std::log(5e-3), 2.848227098998929e-3);
  const auto blend = [](NeighbourhoodLaw which) {
    return neighbourhood_blend(make_neighbourhood(which, 3e-3, 10e-3), {5e-3, 0, 0});
  };
  expect_worked(blend(NeighbourhoodLaw::kLogPaper), 0.575716642493445);
  expect_worked(blend(NeighbourhoodLaw::kLogC1), 0.4247780142648475);
  expect_worked(blend(NeighbourhoodLaw::kPunch), 0.4096655293982669);  // 2/pi asin(3/5): a flat end, Sneddon 1965
}

// What stands beside the temporal order: two contacts with compliances of 3e-5 and 1e-5 m/N.
TEST(CuiXiao2008, ContactsThatLeanOnOneAnother) {
  const struct {
    double depth_mm[2], left_mm[2], force_N[2];
  } rows[] = {{{3, 3}, {2.746888599097781, 2.746888599097781}, {6.327785022555463, 6.327785022555463}},
              {{4, 2}, {3.568363673396977, 1.806991957119444}, {13.77376171160643, 1.842347525483056}},
              {{4.3577, 0.5}, {3.842320410171288, 0.3275761812744227}, {17.17143688450698, 0.02364832935025}}};
  const Real compliance[4] = {3e-5, 1e-5, 1e-5, 3e-5};
  for (const auto& row : rows) {
    std::vector<Contact> contact(2);
    const std::int32_t index[2] = {0, 1};
    for (std::size_t i = 0; i < 2; ++i) {
      contact[i].depth_m = 1e-3 * row.depth_mm[i];
      contact[i].weight = 1;
    }
    const RegionRows view[2] = {{contact.data(), index, 1}, {contact.data(), index + 1, 1}};
    RegionSystem system{};
    solve_regions(PointLaws{{40, 3e8, kHuge}, view, compliance, 2}, 2, system);
    for (int i = 0; i < 2; ++i) {
      expect_worked(row.depth_mm[i] - 1e3 * system.shift_m[i], row.left_mm[i]);
      expect_worked(system.force_N[i], row.force_N[i]);
    }
  }
}

}  // namespace
}  // namespace palpate::test
