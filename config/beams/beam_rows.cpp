#include "config/beams/beam_rows.h"

#include <Eigen/Dense>
#include <cmath>

namespace palpate {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Below these an arc is a straight beam: the circular formulas lose C22's digits with the cube of the angle.
constexpr double kLeastAngle = 1e-3;
constexpr double kLeastSagitta = 1e-3;  // of the chord

// Gauss-Legendre on [-1, 1].
constexpr int kGauss = 8;
constexpr double kGaussAt[kGauss] = {-0.9602898564975362317, -0.7966664774136267396, -0.5255324099163289858,
                                     -0.1834346424956498049, 0.1834346424956498049,  0.5255324099163289858,
                                     0.7966664774136267396,  0.9602898564975362317};
constexpr double kGaussWeight[kGauss] = {0.1012285362903762591, 0.2223810344533744706, 0.3137066458778872873,
                                         0.3626837833783619830, 0.3626837833783619830, 0.3137066458778872873,
                                         0.2223810344533744706, 0.1012285362903762591};

Vector3d eigen(Vec3 v) { return {v.x, v.y, v.z}; }
// cross_of(a) b = a x b
Matrix3d cross_of(Vec3 a) {
  Matrix3d m;
  m << 0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0;
  return m;
}

struct Frame {
  Vec3 position_m;                 // of the middle line
  Vec3 tangent, normal, binormal;  // normal: outwards, away from the centre of the circle
};
// The middle line at `along_m` from the clamp. Of an arc it lies half the width inside the circle.
Frame frame_at(const BeamCurve& curve, const BeamBuild& build, double along_m) {
  if (curve.path == BeamPath::kStraight)
    return {curve.anchor_m - along_m * curve.tangential, curve.tangential, curve.radial, curve.up};
  const double r0 = curve.outer_radius_m - 0.5 * build.width_m;
  const double angle = curve.angle - along_m / r0, c = std::cos(angle), s = std::sin(angle);
  const Vec3 radial = c * curve.radial + s * curve.tangential, tangent = -s * curve.radial + c * curve.tangential;
  return {curve.centre_m + r0 * radial, tangent, radial, curve.up};
}
double middle_length_m(const BeamCurve& curve, const BeamBuild& build) {
  return curve.path == BeamPath::kStraight ? curve.length_m
                                           : curve.angle * (curve.outer_radius_m - 0.5 * build.width_m);
}

struct Section {
  double area, inertia_in, inertia_out, torsion, g;
};
Section section_of(const BeamBuild& build) {
  const double w = build.width_m, t = build.thickness_m;
  return {w * t, t * w * w * w / 12, w * t * t * t / 12, rectangle_torsion_m4(w, t),
          build.material.youngs_modulus_Pa / (2 * (1 + build.material.poisson_ratio))};
}

// Sections' flexibility per length for moments (about tangent, normal, binormal) and for forces.
Matrix3d moment_flexibility(const Frame& f, const Section& s, double e) {
  const Vector3d t = eigen(f.tangent), n = eigen(f.normal), b = eigen(f.binormal);
  return t * t.transpose() / (s.g * s.torsion) + n * n.transpose() / (e * s.inertia_out) +
         b * b.transpose() / (e * s.inertia_in);
}
Matrix3d force_flexibility(const Frame& f, const Section& s, double e) {
  const Matrix3d tt = eigen(f.tangent) * eigen(f.tangent).transpose();
  return tt / (e * s.area) + 1.2 * (Matrix3d::Identity() - tt) / (s.g * s.area);
}

// int over the middle line from the clamp to `end_m` of the flexibilities, between forces at `of` and at the tip.
Matrix3d integrate_to(const BeamCurve& curve, const BeamBuild& build, double end_m, Vec3 of) {
  const Section s = section_of(build);
  Matrix3d sum = Matrix3d::Zero();
  const int pieces = curve.path == BeamPath::kStraight ? 1 : 1 + static_cast<int>(curve.angle / (0.5 * kPi));
  for (int piece = 0; piece < pieces; ++piece)
    for (int q = 0; q < kGauss; ++q) {
      const double x = end_m * (piece + 0.5 * (1 + kGaussAt[q])) / pieces;
      const Frame f = frame_at(curve, build, x);
      const double e = build.material.youngs_modulus_Pa;
      sum += 0.5 * kGaussWeight[q] * end_m / pieces *
             (force_flexibility(f, s, e) + cross_of(of - f.position_m).transpose() * moment_flexibility(f, s, e) *
                                               cross_of(curve.tip_m - f.position_m));
    }
  return sum;
}

bool is_nearly_straight(const BeamCurve& curve) {
  const double chord = norm(curve.anchor_m - curve.tip_m);
  const double sagitta = curve.outer_radius_m * (1 - std::cos(0.5 * curve.angle));
  return curve.angle < kLeastAngle || sagitta < kLeastSagitta * chord;
}

ArcSection arc_section(const BeamCurve& curve, const BeamBuild& build) {
  return {curve.outer_radius_m - build.width_m, curve.outer_radius_m, build.thickness_m};
}

Matrix3d arc_compliance(const BeamCurve& curve, const BeamBuild& build) {
  const ArcCompliance c =
      arc_tip_compliance(arc_section(curve, build), build.material, curve.angle, curve.outer_radius_m);
  const Vector3d r = eigen(curve.radial), t = eigen(curve.tangential), z = eigen(curve.up);
  return c.rr_m_per_N * r * r.transpose() + c.tt_m_per_N * t * t.transpose() +
         c.rt_m_per_N * (r * t.transpose() + t * r.transpose()) + c.zz_m_per_N * z * z.transpose();
}

// Stress rows of beam theory at the clamp: straight beams, and the out-of-plane part of arcs.
Eigen::Matrix<double, 6, 3> beam_theory_stress(const BeamCurve& curve, const BeamBuild& build) {
  const Section s = section_of(build);
  const Frame f = frame_at(curve, build, 0);
  const Vec3 rho = curve.tip_m - f.position_m;
  // The section's outward normal points towards the tip: a force along it pulls. M = rho x F.
  const Vec3 pull = -f.tangent;
  const Vec3 about_binormal = cross(f.binormal, rho), about_normal = cross(f.normal, rho);
  const double fibre = 0.5 * build.width_m / s.inertia_in;
  const double side = 0.5 * build.thickness_m / s.inertia_out;
  Eigen::Matrix<double, 6, 3> rows;
  // binormal = normal x tangent, and the traction on the tip's side balances rho x F: stress falls outwards by M.b / I.
  rows.row(0) = eigen((1 / s.area) * pull + fibre * about_binormal).transpose();
  rows.row(1) = eigen((1 / s.area) * pull - fibre * about_binormal).transpose();
  rows.row(2) = eigen(side * about_normal).transpose();
  rows.row(3) = eigen((1 / s.area) * pull).transpose();
  rows.row(4) = eigen((1.5 / s.area) * f.normal).transpose();
  rows.row(5) = eigen((1.5 / s.area) * f.binormal).transpose();
  return rows;
}

// In-plane stress rows of an arc from the exact solution.
void use_exact_stress(const BeamCurve& curve, const BeamBuild& build, Eigen::Matrix<double, 6, 3>& rows) {
  const ArcSection section = arc_section(curve, build);
  const double b = section.outer_m, middle = middle_radius_m(section);
  const auto at = [&](double fr, double ft, double r) {
    if (!build.paper) return arc_stress(section, tip_force(fr, ft, b), r, curve.angle);
    // F1 presses inwards, F2 pulls along theta^.
    return arc_stress_paper(section, -fr, ft, r, curve.angle);
  };
  const auto row = [&](double radial, double tangential) {
    return (radial * eigen(curve.radial) + tangential * eigen(curve.tangential)).transpose().eval();
  };
  rows.row(0) = row(at(1, 0, section.inner_m).hoop_Pa, at(0, 1, section.inner_m).hoop_Pa);
  rows.row(1) = row(at(1, 0, b).hoop_Pa, at(0, 1, b).hoop_Pa);
  rows.row(4) = row(at(1, 0, middle).shear_Pa, at(0, 1, middle).shear_Pa);
}

// Inverse of the paper's relation between (u, v) and (F1, F2); of a straight beam, bending is F1 and pulling is F2.
BeamRatio ratio_of(const BeamCurve& curve, const BeamBuild& build, const Matrix3d& compliance) {
  BeamRatio ratio{};
  ratio.f1_axis = -curve.radial;
  ratio.f2_axis = curve.tangential;
  if (curve.path == BeamPath::kStraight || curve.path == BeamPath::kPoint) {
    const Vector3d n = eigen(curve.radial), t = eigen(curve.tangential);
    // A beam without length gives nothing and shares nothing.
    const auto stiffness = [&](const Vector3d& along) {
      const double give = along.dot(compliance * along);
      return give > 0 ? 1 / give : 0.0;
    };
    ratio.f1_gain_N_per_m = -stiffness(n) * curve.radial;
    ratio.f2_gain_N_per_m = stiffness(t) * curve.tangential;
    return ratio;
  }
  const ArcPaperCompliance c =
      arc_paper_compliance(arc_section(curve, build), build.material, curve.angle, curve.outer_radius_m);
  const double determinant = c.u1_m_per_N * c.v2_m_per_N - c.u2_m_per_N * c.v1_m_per_N;
  // The relation is indefinite: where it is nearly singular its inverse is all rounding, and nothing is shared.
  if (!(std::abs(determinant) > 1e-3 * std::abs(c.u1_m_per_N * c.v2_m_per_N))) return ratio;
  const double per = 1 / determinant;
  ratio.f1_gain_N_per_m = (per * c.v2_m_per_N) * curve.radial - (per * c.u2_m_per_N) * curve.tangential;
  ratio.f2_gain_N_per_m = (per * c.u1_m_per_N) * curve.tangential - (per * c.v1_m_per_N) * curve.radial;
  return ratio;
}

}  // namespace

double BeamBuild::equivalent_radius_m() const { return std::sqrt(width_m * thickness_m / kPi); }

Matrix3d curve_compliance(const BeamCurve& curve, const BeamBuild& build) {
  return integrate_to(curve, build, middle_length_m(curve, build), curve.tip_m);
}

Matrix3d release_compliance(const BeamCurve& curve, const BeamBuild& build) {
  const double end = std::min(build.release_length_m, middle_length_m(curve, build));
  return integrate_to(curve, build, end, frame_at(curve, build, end).position_m);
}

Matrix3d foot_compliance(const BeamBuild& build, Vec3 anchor_normal) {
  const double e = build.material.youngs_modulus_Pa, nu = build.material.poisson_ratio;
  const double r = build.equivalent_radius_m(), g = e / (2 * (1 + nu));
  const double normal = (1 - nu * nu) / (2 * e * r), across = (2 - nu) / (8 * g * r);
  const Vector3d n = eigen(anchor_normal);
  return across * Matrix3d::Identity() + (normal - across) * n * n.transpose();
}

BeamRows beam_rows(const BeamCurve& given, const BeamBuild& build, Vec3 anchor_normal) {
  BeamRows rows;
  if (given.path == BeamPath::kNone) return rows;
  BeamCurve curve = given;
  const bool arc = curve.path >= BeamPath::kArc && !is_nearly_straight(curve);
  if (!arc && curve.path >= BeamPath::kArc) curve = straight_through(given.tip_m, given.anchor_m, given.radial);
  const Matrix3d foot = foot_compliance(build, anchor_normal);
  if (curve.path == BeamPath::kPoint) {
    rows.stiffness = foot.inverse();
    rows.release = foot;  // the whole displacement of the contact is the anchor's
    const Section s = section_of(build);
    for (int k : {0, 1, 3}) rows.stress.row(k) = (1 / s.area) * eigen(anchor_normal).transpose();
    rows.ratio = ratio_of(curve, build, foot);
    return rows;
  }
  const Matrix3d beam = arc ? arc_compliance(curve, build) : curve_compliance(curve, build);
  const Matrix3d inverse = (beam + foot).inverse();
  rows.stiffness = 0.5 * (inverse + inverse.transpose());
  // A beam shorter than the release length makes up for what is missing with its foot, so that a contact that reaches
  // the anchor takes it along.
  const double missing = std::max(1 - middle_length_m(curve, build) / build.release_length_m, 0.0);
  rows.release = release_compliance(curve, build) + missing * foot;
  rows.stress = beam_theory_stress(curve, build);
  if (arc) use_exact_stress(curve, build, rows.stress);
  if (build.paper) rows.ratio = ratio_of(curve, build, beam);
  return rows;
}

BeamRows beam_rows(const BeamChoice& choice, const BeamBuild& build, Vec3 anchor_normal) {
  BeamRows sum;
  if (choice.count == 0) return sum;
  if (choice.count == 1) return beam_rows(choice.curve[0], build, anchor_normal);
  Matrix3d release = Matrix3d::Zero();
  Eigen::Matrix<double, 6, 3> stress = Eigen::Matrix<double, 6, 3>::Zero();
  for (int way = 0; way < choice.count; ++way) {
    const BeamRows rows = beam_rows(choice.curve[way], build, anchor_normal);
    const Matrix3d k = choice.weight[way] * rows.stiffness;
    sum.stiffness += k;
    release += rows.release * k;
    stress += rows.stress * k;
    if (way == 0) sum.ratio = rows.ratio;
  }
  const Matrix3d per_force = sum.stiffness.inverse();
  sum.release = release * per_force;
  sum.stress = stress * per_force;
  return sum;
}

}  // namespace palpate
