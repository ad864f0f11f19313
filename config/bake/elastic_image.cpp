#include "config/bake/elastic_image.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "config/bake/drawn_fields.h"
#include "config/bake/edge_fits.h"
#include "config/bake/elastic_mesh.h"
#include "config/bake/facet_foot.h"
#include "config/bake/fem_body.h"
#include "config/bake/image_rules.h"
#include "config/bake/sample_field.h"
#include "config/bake/sample_nodes.h"
#include "config/bake/surface_parts.h"
#include "config/bake/vertex_slopes.h"
#include "config/body/supports.h"
#include "config/elastic/elastic_body.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/large_strain_elements.h"
#include "config/index.h"
#include "config/response/corner_normals.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"
#include "rt_core/contact/elastic/ball_on_body.h"
#include "rt_core/contact/elastic/elastic_layout.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

using Field = Eigen::VectorXd;  // [node * 3 + component]
using elastic::vec;
using elastic::Vector;

// Self terms are smooth along a body: samples this share of its size apart, and never nearer than an element's edge.
// With 0.08 the middle of a pad, inside a rim that gives much more, came out 7 % off its neighbours (2026-11-25).
constexpr double kSampleSpacing = 0.055;
// The baker's meshes are even, and large against the wall: see PatchOptions. Too stiff: 1.4 to 2.2 and 0.5 to 0.8 % of
// a half space's give under the two patches, in the middle of the bonded layers `layer` and `pad` of tests/accuracy,
// whose give their kernel tells (2026-11-25).
constexpr elastic::PatchOptions kPatch{0.75, 0.0063};

Vector<3> eigen(Vec3 v) { return {v.x, v.y, v.z}; }

// du_i/dX_j of a field at every surface node, [node * 9 + 3 i + j]: the mean of the elements' own there.
class NodalGradient {
 public:
  NodalGradient(const TetMesh& mesh, const elastic::Surface<3>& surface)
      : mesh_(mesh), tables_(fem::element_tables<3>(fem::StrainElement::kT10)), count_(mesh.node_m.size()) {
    for (std::size_t t = 0; t < mesh.tet.size(); ++t)
      for (const std::int32_t node : mesh.tet[t].node)
        if (!surface.facets_at(node).empty()) ++count_[at(node)];
    for (std::size_t n = 0; n < count_.size(); ++n) wanted_.push_back(!surface.facets_at(static_cast<int>(n)).empty());
  }
  Field of(const Field& u) const {
    Field out = Field::Zero(static_cast<Eigen::Index>(9 * count_.size()));
    for (const Tet& tet : mesh_.tet)
      for (std::size_t n = 0; n < 10; ++n) {
        if (!wanted_[at(tet.node[n])]) continue;
        Eigen::Matrix3d x = Eigen::Matrix3d::Zero(), g = Eigen::Matrix3d::Zero();  // d/d parameter of place and field
        for (std::size_t a = 0; a < 10; ++a) {
          const auto& slope = tables_.gradient_at_nodes[n * 10 + a];
          const Eigen::RowVector3d row(slope[0], slope[1], slope[2]);
          x += eigen(mesh_.node_m[at(tet.node[a])]) * row;
          g += u.segment<3>(3 * tet.node[a]) * row;
        }
        const Eigen::Matrix3d gradient = g * x.inverse();
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) out[9 * tet.node[n] + 3 * i + j] += gradient(i, j) / count_[at(tet.node[n])];
      }
    return out;
  }

 private:
  const TetMesh& mesh_;
  fem::ElementTables<3> tables_;
  std::vector<double> count_;
  std::vector<bool> wanted_;
};

// c, c1 and beta anywhere on the surface.
SampleField self_field(const elastic::Surface<3>& surface, const elastic::SelfTerms& terms,
                       const std::vector<double>& beta, double spacing_m) {
  const auto n = static_cast<Eigen::Index>(terms.nodes.size());
  Eigen::MatrixXd value(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t node = at(terms.nodes[static_cast<std::size_t>(i)]);
    value.row(i) << terms.self_mpN[node], terms.second_mpN2[node], beta[static_cast<std::size_t>(i)];
  }
  return tame_field(surface, terms.nodes, value, spacing_m);
}

bool is_of_balls(const ImageContents& image) {
  return std::ranges::all_of(image.piece, [](const ToolPiece& p) { return p.shape == PieceShape::kSphere; });
}

// How the surface curves at the vertices, convex positive: principal curvatures, and that of the sphere that stands for
// them: under a tool of balls the one that the largest dents alike, else their mean, for along a line the tick tells
// the other curvature by it (line_place.cpp).
struct Curvatures {
  std::vector<std::array<double, 2>> principal_1pm;
  std::vector<double> sphere_1pm;
};
Curvatures curvatures_of(const ImageContents& image, const std::vector<CornerNormals>& normals, double largest_m) {
  const double ball_m = is_of_balls(image) ? largest_m : 0;
  Curvatures out;
  for (const Bend& form : vertex_curvatures(image.vertex_m, normals, image.triangle)) {
    out.principal_1pm.push_back(principal_curvatures(form));
    out.sphere_1pm.push_back(elastic::equal_sphere_1pm(out.principal_1pm.back(), ball_m));
  }
  return out;
}

// Distinct orders of the indices.
template <std::size_t kDegree>
double orders_of(const std::array<int, kDegree>& index) {
  double orders = 1;
  for (std::size_t i = 0, run = 0; i < kDegree; ++i) {
    run = i > 0 && index[i] == index[i - 1] ? run + 1 : 1;
    orders *= static_cast<double>(i + 1) / static_cast<double>(run);
  }
  return orders;
}

void add_energy(const elastic::SoftPotential& v, ImageContents& image) {
  using elastic_layout::pair_place;
  const int s = static_cast<int>(v.size()), pairs = elastic_layout::pairs(s);
  const Eigen::VectorXd root = v.lambda().cwiseSqrt();
  image.elastic_cubic.assign(at(pairs * s), 0);
  image.elastic_quartic.assign(at(pairs * pairs), 0);
  for (int a = 0; a < s; ++a)
    for (int b = a; b < s; ++b)
      for (int c = 0; c < s; ++c) {
        std::array<int, 3> i3{a, b, c};
        std::sort(i3.begin(), i3.end());
        image.elastic_cubic[at(c * pairs + pair_place(a, b, s))] =
            v.cubic[static_cast<Eigen::Index>(v.cubic_place(a, b, c))] / orders_of(i3) / (root[a] * root[b] * root[c]);
        for (int d = c; d < s; ++d) {
          std::array<int, 4> i4{a, b, c, d};
          std::sort(i4.begin(), i4.end());
          image.elastic_quartic[at(pair_place(c, d, s) * pairs + pair_place(a, b, s))] =
              (c == d ? 1 : 2) * v.quartic[static_cast<Eigen::Index>(v.quartic_place(a, b, c, d))] / orders_of(i4) /
              (root[a] * root[b] * root[c] * root[d]);
        }
      }
}

// Shapes of the terms, scaled to J^1/2, with their gradients.
struct Shapes {
  std::vector<Field> u, gradient;
};
Shapes term_shapes(const elastic::ElasticBody<3>& body, const NodalGradient& gradient) {
  const int s = body.soft;
  const Eigen::VectorXd root = body.modes.lambda_Npm3.cwiseSqrt();
  Shapes out;
  for (int a = 0; a < s; ++a) out.u.push_back(body.modes.phi_1pm.col(a) / root[a]);
  for (int a = 0; a < s; ++a)
    for (int b = a; b < s; ++b)
      out.u.push_back(body.maps.theta_1pm3[elastic::pair_place(a, b, s)] *
                      ((a == b ? 0.5 : 1.0) / (root[a] * root[b])));
  for (const Field& u : out.u) out.gradient.push_back(gradient.of(u));
  return out;
}

// The largest of the tool's balls; of no radius where it has none.
elastic::BallLaw largest_ball(const ImageContents& image, const elastic::RestBody<3>& rest) {
  elastic::BallLaw ball{0, rest.contact_modulus(), false, rest.material().poisson_ratio, 0, {}};
  for (std::size_t p = 0; p < image.piece.size(); ++p) {
    const TipLaw& law = image.tip_law[p];
    if (image.piece[p].point_count == 0 || law.half_power != 3) continue;
    const double radius = image.tool_point[at(image.piece[p].first_point)].margin_m;
    if (radius <= ball.radius_m) continue;
    ball.radius_m = radius;
    ball.paraboloid = law.first_factor < 0;
  }
  return ball;
}

void add_vertices(const elastic::ElasticBody<3>& body, const Shapes& shapes, const SampleField& self,
                  const EdgeFits& edges, const std::vector<FacetFoot>& feet, const Curvatures& curvatures,
                  ImageContents& image) {
  using namespace elastic_layout;
  const int s = body.soft, linear = static_cast<int>(body.modes.lambda_Npm3.size()) - s;
  const auto stride = at(vertex_floats(s, linear));
  image.elastic_vertex.assign(stride * image.vertex_m.size(), 0);
  std::vector<Field> linear_shapes;
  for (int m = s; m < s + linear; ++m)
    linear_shapes.emplace_back(body.modes.phi_1pm.col(m) / std::sqrt(body.modes.lambda_Npm3[m]));
  for (std::size_t v = 0; v < image.vertex_m.size(); ++v) {
    const FacetFoot& foot = feet[v];
    float* out = &image.elastic_vertex[stride * v];
    const auto show = [&](const Field& field, int width, int component) {
      double sum = 0;
      for (std::size_t a = 0; a < foot.node.size(); ++a)
        sum += foot.shape.value[a] * field[width * foot.node[a] + component];
      return static_cast<float>(sum);
    };
    for (std::size_t t = 0; t < shapes.u.size(); ++t) {
      for (int i = 0; i < 3; ++i) *out++ = show(shapes.u[t], 3, i);
      for (int i = 0; i < 9; ++i) *out++ = show(shapes.gradient[t], 9, i);
    }
    const Eigen::RowVectorXd own = self.show(image.vertex_m[v], image.vertex_normal[v]);
    const double curvature = curvatures.sphere_1pm[v];
    const elastic::EdgeFit edge = edges.of_vertex(image.vertex_m[v], image.vertex_normal[v],
                                                  body.rest->contact_modulus(foot.node.front()), curvature);
    *out++ = static_cast<float>(own[0] + edge.give_mpN);
    *out++ = static_cast<float>(own[1]);
    *out++ = static_cast<float>(scaled_curvature_1pm(curvature, edge.scale, edges.radius_m()));
    *out++ = static_cast<float>(own[2]);
    out += elastic_layout::kOwnFloats - elastic_layout::kOwnValues;
    for (const Field& phi : linear_shapes)
      for (int i = 0; i < 3; ++i) *out++ = show(phi, 3, i);
  }
}

// The slopes of c, c1, curvature and beta along the surface, and their own, from what stands at the vertices.
void add_own_slopes(const elastic::ElasticBody<3>& body, const std::vector<CornerNormals>& normals,
                    ImageContents& image) {
  using namespace elastic_layout;
  const int s = body.soft, linear = static_cast<int>(body.modes.lambda_Npm3.size()) - s;
  const auto stride = at(vertex_floats(s, linear)), own = at(kTermFloats * terms(s));
  for (std::size_t which = 0; which < kOwnSlopes; ++which) {
    std::vector<double> value(image.vertex_m.size());
    for (std::size_t v = 0; v < value.size(); ++v)
      value[v] = static_cast<double>(image.elastic_vertex[stride * v + own + which]);
    std::vector<Vec3> slope = vertex_slopes(image.vertex_m, image.vertex_normal, image.triangle, value);
    stop_at_sharp_edges(image.vertex_m, normals, image.triangle, slope);
    const std::vector<Bend> bend = vertex_bends(image.vertex_m, image.triangle, value, slope);
    for (std::size_t v = 0; v < value.size(); ++v) {
      float* out = &image.elastic_vertex[stride * v + own + kOwnValues + 3 * which];
      out[0] = static_cast<float>(slope[v].x);
      out[1] = static_cast<float>(slope[v].y);
      out[2] = static_cast<float>(slope[v].z);
      out = &image.elastic_vertex[stride * v + own + kOwnBends + which];
      for (std::size_t i = 0; i < bend[v].size(); ++i) out[kOwnSlopes * i] = static_cast<float>(bend[v][i]);
    }
  }
}

// The contact modulus at the vertices, of that of the scene's own material, where a body has several.
void add_moduli(const elastic::RestBody<3>& rest, const std::vector<FacetFoot>& feet, ImageContents& image) {
  if (rest.material().element.empty()) return;
  for (const FacetFoot& foot : feet) {
    double sum = 0, weight = 0;  // a quadratic facet's weights may be negative; a modulus may not
    for (std::size_t a = 0; a < foot.node.size(); ++a) {
      const double share = std::max(foot.shape.value[a], 0.0);
      sum += share * rest.contact_modulus(foot.node[a]);
      weight += share;
    }
    image.elastic_vertex.push_back(
        static_cast<float>(clamp_to(sum / weight / rest.contact_modulus(), elastic_layout::kLeastModulusRatio * 1.001,
                                    elastic_layout::kMostModulusRatio * 0.999)));
  }
}

elastic::ElasticOptions options_of(int soft, int linear, unsigned jobs) {
  elastic::ElasticOptions options;
  options.soft = soft;
  options.linear = linear;
  options.second_order = true;
  options.patch = kPatch;
  options.jobs = jobs;
  return options;
}

// The vertex nearest to a node that looks the same way, -1 where none does: bent facets do not tell how the body
// curves.
int vertex_at(const elastic::Surface<3>& surface, int node, const ImageContents& image) {
  const Vec3 place = vec(surface.rest(node)), normal = vec(elastic::node_normal(surface, node));
  double nearest = kHuge;
  int found = -1;
  for (std::size_t v = 0; v < image.vertex_m.size(); ++v) {
    const double distance = norm(image.vertex_m[v] - place);
    if (!(distance < nearest) || dot(image.vertex_normal[v], normal) < kFacing) continue;
    nearest = distance;
    found = static_cast<int>(v);
  }
  return found;
}

// Beta of every sample, for the largest ball; the tick scales it to the others. What the fit adds to c is added.
std::vector<double> fit_places(elastic::SelfTerms& self, const elastic::RestBody<3>& rest, const ImageContents& image,
                               const Curvatures& curvatures, const EdgeFits& edges, elastic::BallLaw ball) {
  std::vector<double> beta(self.nodes.size(), 0.0);
  if (!(ball.radius_m > 0)) return beta;
  for (std::size_t i = 0; i < beta.size(); ++i) {
    const std::size_t node = at(self.nodes[i]);
    const int vertex = vertex_at(rest.surface(), self.nodes[i], image);
    ball.modulus_Pa = rest.contact_modulus(self.nodes[i]);
    ball.body_curvature_1pm =
        vertex < 0 ? 0 : (sharper(curvatures.sphere_1pm[at(vertex)], ball.radius_m) - 1) / ball.radius_m;
    ball.principal_1pm = vertex < 0 ? std::array<double, 2>{} : curvatures.principal_1pm[at(vertex)];
    const elastic::PlaceFit fit =
        elastic::fit_place(ball, self.width[node], self.self_mpN[node], image.params.max_depth_m);
    beta[i] = fit.beta_1pmN;
    const elastic::EdgeFit edge =
        edges.of_sample(rest.surface(), self.nodes[i], ball.modulus_Pa, ball.body_curvature_1pm);
    self.self_mpN[node] += fit.more_give_mpN - edge.give_mpN;
  }
  return beta;
}

// Of a part of the surface one set of numbers: the curvature where it begins, and the mean c of what is about as
// curved, no less than the linear modes' share. On an arm c is a small difference of large numbers, and what its
// changes from place to place asked for along the surface was a tenth of the force (2026-11-26); c1 and beta would be
// less than a hundredth of the way.
class PartNumbers {
 public:
  PartNumbers(const elastic::ElasticBody<3>& body, ImageContents& image)
      : image_(image),
        linear_(static_cast<int>(body.modes.lambda_Npm3.size()) - body.soft),
        stride_(at(elastic_layout::vertex_floats(body.soft, linear_))),
        own_(at(elastic_layout::kTermFloats * elastic_layout::terms(body.soft))) {}

  // Where a part begins is where the tick reads it (show_place_numbers), whatever part has a shared vertex last.
  void hold() const {
    std::vector<Numbers> held;
    for (const ToolPoint& point : image_.tool_point) held.push_back(numbers_of(point));
    for (std::size_t i = 0; i < held.size(); ++i)
      for (const std::int32_t t : part_of(model_of(image_), image_.tool_point[i].begins_at))
        for (const std::int32_t v : image_.triangle[at(t)].vertex) std::ranges::copy(held[i], own_of(v));
    for (std::size_t i = 0; i < held.size(); ++i) std::ranges::copy(held[i], own_of(first_of(image_.tool_point[i])));
  }

 private:
  using Numbers = std::array<float, elastic_layout::kOwnValues>;

  float* own_of(std::int32_t v) const { return &image_.elastic_vertex[stride_ * at(v) + own_]; }
  std::int32_t first_of(const ToolPoint& point) const { return image_.triangle[at(point.begins_at)].vertex[0]; }
  double linear_share(std::int32_t vertex, Vec3 normal) const {
    const float* u = own_of(vertex) + elastic_layout::kOwnFloats;
    double sum = 0;
    for (int m = 0; m < linear_; ++m, u += 3) {
      const double along =
          dot(normal, {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])});
      sum += along * along;
    }
    return sum;
  }
  Numbers numbers_of(const ToolPoint& point) const {
    const float curvature = own_of(first_of(point))[2];
    double c = 0, least = 0;
    int count = 0;
    for (const std::int32_t t : part_of(model_of(image_), point.begins_at))
      for (int k = 0; k < 3; ++k) {
        const std::int32_t vertex = image_.triangle[at(t)].vertex[k];
        if (std::abs(own_of(vertex)[2] - curvature) > 0.5f * std::abs(curvature)) continue;
        least += linear_share(vertex, image_.corner_normal[at(t)].normal[k]);
        c += static_cast<double>(own_of(vertex)[0]);
        count += 1;
      }
    return {static_cast<float>(std::max(c, least) / count), 0, curvature, 0};
  }

  ImageContents& image_;
  const int linear_;
  const std::size_t stride_, own_;
};

}  // namespace

struct ElasticBake::Parts {
  unsigned jobs;
  TetMesh mesh;
  std::vector<bool> fixed;
  elastic::RestBody<3> rest;
  double spacing_m;
  std::vector<FacetFoot> feet;
  std::vector<CornerNormals> normals;
  double edge_reach_m;
  SharpEdges edges;
  DrawnFields drawn;
  elastic::ElasticStock<3> stock;
  NodalGradient gradient;
  elastic::ElasticBody<3> last;  // a number of modes is written with several self compliances in turn
  int last_soft = 0, last_linear = -1;

  Parts(const SceneDesc& scene, const ImageContents& image, int modes, TetMesh body, std::vector<bool> held,
        unsigned threads)
      : jobs(threads),
        mesh(std::move(body)),
        fixed(std::move(held)),
        rest(elastic::solid_mesh(mesh, scene.source.where("body.shape")), elastic_material(scene, image.params, mesh),
             fixed),
        spacing_m(kSampleSpacing * rest.surface().extent_m()),
        feet(facet_feet(rest.surface(), image.vertex_m)),
        normals(corner_normals(scene.body, image.vertex_m, image.triangle)),
        edge_reach_m(reach_of_edges_m(rest.surface())),
        edges(is_of_balls(image) ? free_sharp_edges(image, normals, feet, fixed) : SharpEdges()),
        drawn(rest, feet, image.vertex_m, image.vertex_normal, image.params.max_depth_m),
        stock(elastic::make_elastic_stock(rest,
                                          sample_nodes(rest.surface(), fixed, spacing_m, edges, edge_reach_m,
                                                       kNarrowRadii * largest_ball(image, rest).radius_m),
                                          modes, options_of(modes, 0, jobs),
                                          [this](const elastic::PressedPlace& place) { drawn.add(place); })),
        gradient(mesh, rest.surface()) {}

  const elastic::ElasticBody<3>& body(int soft, int linear) {
    if (soft != last_soft || linear != last_linear) {
      last = {};  // of 100,000 nodes it has 100 MB: not two at once
      last = elastic::make_elastic_body(stock, options_of(soft, linear, jobs));
      last_soft = soft;
      last_linear = linear;
    }
    return last;
  }
};

ElasticBake::ElasticBake(const SceneDesc& scene, const ImageContents& image, int modes,
                         std::vector<std::string>& warnings, unsigned jobs) {
  TetMesh mesh = make_elastic_mesh(scene, image, warnings);
  const Supports supports = supports_of(scene, mesh);
  const std::vector<ElasticBed> beds = beds_of(scene, mesh);
  // What a bed along the surface's normal leaves free depends on the surface: the stiffness's factor says so.
  if (std::ranges::none_of(beds, &ElasticBed::normal))
    check_supports(mesh, supports_and_beds(supports, beds), scene.source.where("body.shape"));
  parts_ = std::make_unique<Parts>(scene, image, modes, std::move(mesh), elastic::fixed_components(supports), jobs);
}
ElasticBake::~ElasticBake() = default;

const TetMesh& ElasticBake::mesh() const { return parts_->mesh; }
double ElasticBake::factor_multiplications() const { return parts_->rest.factor_multiplications(); }

ElasticReport ElasticBake::write(int soft, int linear, double add_c_mpN, ImageContents& image, Drawn drawn) const {
  Parts& parts = *parts_;
  const elastic::ElasticBody<3>& body = parts.body(soft, linear);
  elastic::SelfTerms terms = body.self;
  for (const int node : terms.nodes) terms.self_mpN[at(node)] += add_c_mpN;
  const elastic::BallLaw ball = largest_ball(image, parts.rest);
  const Curvatures curvatures = curvatures_of(image, parts.normals, ball.radius_m);
  const EdgeFits edges(parts.edges, parts.edge_reach_m, ball, image.params.max_depth_m);
  const std::vector<double> beta = fit_places(terms, parts.rest, image, curvatures, edges, ball);
  const SampleField self = self_field(parts.rest.surface(), terms, beta, parts.spacing_m);
  add_energy(body.maps.potential, image);
  add_vertices(body, term_shapes(body, parts.gradient), self, edges, parts.feet, curvatures, image);
  if (touches_in_parts(model_of(image)))
    PartNumbers(body, image).hold();
  else
    add_own_slopes(body, parts.normals, image);
  if (drawn == Drawn::kWritten)
    parts.drawn.append(body, parts.spacing_m, image.elastic_vertex);
  else
    image.elastic_vertex.push_back(0);  // of no shapes
  add_moduli(parts.rest, parts.feet, image);
  ModelParams& p = image.params;
  p.elastic_soft = body.soft;
  p.elastic_linear = static_cast<std::int32_t>(body.modes.lambda_Npm3.size()) - body.soft;
  p.elastic_radius_rootJ = body.maps.potential.radius_rootJ;
  const double largest = body.modes.phi_1pm.col(0).cwiseAbs().maxCoeff();
  ElasticReport report;
  report.nodes = static_cast<std::int64_t>(parts.mesh.node_m.size());
  report.elements = static_cast<std::int64_t>(parts.mesh.tet.size());
  report.soft = p.elastic_soft;
  report.linear = p.elastic_linear;
  report.samples = static_cast<std::int32_t>(parts.stock.samples.size());
  report.radius_rootJ = p.elastic_radius_rootJ;
  report.softest_N_per_m = body.modes.lambda_Npm3[0] / (largest * largest);
  return report;
}

}  // namespace palpate
