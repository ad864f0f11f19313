#include "sim_host/view/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/hand/hand_model.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/picture_foot.h"
#include "sim_host/view/plot.h"
#include "sim_host/view/png_file.h"
#include "sim_host/view/stroke_font.h"

namespace palpate {

namespace {

enum Material : std::int32_t { kBody = 0, kAnchorFree, kAnchorFixed, kAnchorStress, kTool, kArrow };

constexpr Colour kInk = colour(0x1f2933), kGrey = colour(0x5b6672);
constexpr Colour kSkinColour = colour(0xd8a488);
constexpr Colour kToolColour = colour(0x6d8fae), kArrowColour = colour(0x1b74c4);

// The ends of the arrows.
std::vector<Vec3> tips_of(const std::vector<DrawnForce>& forces, const ForceScale& scale) {
  std::vector<Vec3> tips;
  for (const DrawnForce& force : forces) tips.push_back(force.tail_w + scale.m_per_N * force.force_N);
  return tips;
}

Camera camera_of(const Model& model, const State& state, const std::vector<Vec3>& tips, const PictureOptions& options) {
  if (options.camera) return *options.camera;
  return default_camera(model, state, tips, double(options.width) / options.height, options.view);
}

// What is drawn together, a band of rows at a time: all of a picture would take 400 MB, which the kernel clears for
// longer than it is drawn.
struct Sheet {
  Layer layer;
  std::vector<PlacedMesh> mesh;
  void begin(int row) {
    layer.begin(row);
    for (const PlacedMesh& placed : mesh) layer.draw(placed);
  }
};

class Renderer {
 public:
  Renderer(const Model& model, const State& state, const DeformedSurface& surface, const PictureOptions& options)
      : model_(model),
        state_(state),
        surface_(surface),
        options_(options),
        is_hand_(model.params.articulation == Articulation::kHand),
        samples_(std::clamp(options.supersampling, 1, 4)),
        forces_(drawn_forces(state)),
        anchors_(anchors_of(model, state)),
        force_scale_(force_scale(options.force_max_N > 0 ? options.force_max_N : force_sum(state).largest_N,
                                 model.params.surface_size_m)),
        camera_(camera_of(model, state, tips_of(forces_, force_scale_), options)),
        projection_(camera_, options.width * samples_, options.height * samples_),
        solid_{{options.width * samples_, options.height * samples_, (kBand + 1) * samples_}, {}},
        rest_(solid_),
        tool_(solid_),
        arrows_(solid_) {}

  Canvas render() {
    choose_scale();
    draw_body();
    draw_anchors();
    for (std::size_t i = 0; i < model_.piece.size(); ++i) {
      const Pose carrier = carrier_w(model_, state_, static_cast<std::int32_t>(i));
      tool_.mesh.emplace_back(is_hand_ ? hand_render_mesh(model_.piece[i], carrier, is_left_hand(model_))
                                       : piece_mesh(model_, model_.piece[i], carrier),
                              projection_, kTool);
    }
    draw_arrows();
    if (!options_.bare) make_shadow();
    Canvas canvas = resolve();
    if (options_.bare) return canvas;
    draw_force_labels(canvas);
    draw_title(canvas);
    const double deep_m = projection_(shadow_centre_).z;
    draw_foot(canvas, Projection(camera_, options_.width, options_.height),
              2 * deep_m * std::tan(0.5 * camera_.vertical_fov_rad) / options_.height, force_scale_);
    return canvas;
  }

 private:
  void choose_scale();
  void draw_body();
  void draw_anchors();
  void draw_arrows();
  void make_shadow();
  Canvas resolve();
  Colour sample(int x, int y) const;
  Colour background(int x, int y) const;
  Vec3 light_from(double right, double up, double back) const {
    return unit_or(right * projection_.right() + up * projection_.up() - back * projection_.forward(), {0, 0, 1});
  }
  Colour shade(Colour base, const Surfel& surfel, int x, int y, float gloss) const;
  Colour solid_colour(int x, int y) const;
  float outline(int x, int y) const;
  void draw_force_labels(Canvas& canvas) const;
  void draw_title(Canvas& canvas) const;
  void draw_legend(Canvas& canvas) const;

  const Model& model_;
  const State& state_;
  const DeformedSurface& surface_;
  const PictureOptions& options_;
  bool is_hand_;
  int samples_;
  std::vector<DrawnForce> forces_;  // the largest first
  AnchorField anchors_;
  ForceScale force_scale_;
  Camera camera_;
  Projection projection_;
  Vec3 key_ = light_from(-0.55, 0.75, 0.55), fill_ = light_from(0.8, 0.1, 0.5);
  // Of pixels. What is around a sample decides its colour, up to a pixel below it.
  static constexpr int kBand = 32;
  Sheet solid_, rest_, tool_, arrows_;
  ColourScale colours_;
  bool on_surface_ = true;  // the surface has the values
  // Soft shadow on the ground: a blurred view of body and tool from above.
  static constexpr int kShadow = 256;
  double ground_y_ = 0, shadow_half_ = 1;
  Vec3 shadow_centre_;
  std::vector<float> shadow_;
};

void Renderer::choose_scale() {
  const double fixed = options_.colour_max;
  colours_ =
      colour_scale(options_.colour, fixed > 0 ? fixed : largest_value(surface_, anchors_, options_.colour), fixed > 0);
  on_surface_ = solves(model_, options_.colour) && options_.colour != SurfaceColour::kStress;
}

void Renderer::draw_body() {
  RenderMesh mesh;
  std::vector<Vec3> rest_m;
  const std::vector<double> value =
      on_surface_ ? drawn_values(surface_, colours_) : std::vector<double>(surface_.rest_m.size());
  for (std::size_t t = 0; t < surface_.triangle.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(surface_.triangle[t][k]);
      mesh.position_m.push_back(surface_.position_m[v]);
      rest_m.push_back(surface_.rest_m[v]);
      mesh.normal.push_back(surface_.corner_normal.empty() ? surface_.normal[v] : surface_.corner_normal[t][k]);
      mesh.value.push_back(value[v]);
    }
    const auto first = static_cast<std::int32_t>(3 * t);
    mesh.triangle.push_back({first, first + 1, first + 2});
  }
  solid_.mesh.emplace_back(mesh, projection_, kBody);
  mesh.position_m = std::move(rest_m);
  rest_.mesh.emplace_back(std::move(mesh), projection_, kBody);
}

void Renderer::draw_anchors() {
  const bool stress = options_.colour == SurfaceColour::kStress;
  for (std::size_t k = 0; k < model_.anchor.size(); ++k) {
    const Anchor& anchor = model_.anchor[k];
    const AnchorLoad& load = anchors_.anchor[k];
    const Vec3 at = anchor.position_m + (anchor.fixed != 0 ? Vec3{} : load.displacement_w);
    RenderMesh ball = sphere_mesh({at, {}}, (stress ? 0.020 : 0.014) * model_.params.surface_size_m);
    ball.value.assign(ball.position_m.size(), load.stress_Pa);
    solid_.mesh.emplace_back(std::move(ball), projection_,
                             stress              ? kAnchorStress
                             : anchor.fixed != 0 ? kAnchorFixed
                                                 : kAnchorFree);
  }
}

void Renderer::draw_arrows() {
  const double size = model_.params.surface_size_m;
  for (const DrawnForce& force : forces_)
    arrows_.mesh.emplace_back(
        arrow_mesh(force.tail_w, force.tail_w + force_scale_.m_per_N * force.force_N, 0.010 * size), projection_,
        kArrow);
}

void Renderer::make_shadow() {
  ground_y_ = 1e30;
  for (const Vec3 v : surface_.position_m) ground_y_ = std::min(ground_y_, v.y);
  shadow_half_ = 1.2 * model_.params.surface_size_m;
  Vec3 centre;
  for (const Vec3 v : model_.vertex_m) centre += v;
  shadow_centre_ = (1.0 / static_cast<double>(model_.vertex_m.size())) * centre;
  constexpr double kHigh = 100.0;  // so far up that the view is parallel
  Camera above;
  above.eye_m = {shadow_centre_.x, ground_y_ + kHigh * shadow_half_, shadow_centre_.z};
  above.target_m = {shadow_centre_.x, ground_y_, shadow_centre_.z};
  above.up = {0, 0, -1};
  above.vertical_fov_rad = 2 * std::atan(1.0 / kHigh);
  Layer layer(kShadow, kShadow);
  RenderMesh body;
  body.position_m = surface_.position_m;
  body.normal = surface_.normal;
  body.triangle = surface_.triangle;
  layer.draw({std::move(body), Projection(above, kShadow, kShadow), kBody});
  shadow_.assign(kShadow * kShadow, 0.0f);
  for (int y = 0; y < kShadow; ++y) {
    for (int x = 0; x < kShadow; ++x) shadow_[static_cast<std::size_t>(y * kShadow + x)] = layer.at(x, y).material >= 0;
  }
  // Three box blurs per axis come close to a Gaussian.
  constexpr int kReach = 9;
  std::vector<float> blurred(shadow_.size());
  for (int pass = 0; pass < 6; ++pass) {
    const int dx = pass % 2, dy = 1 - dx;
    for (int y = 0; y < kShadow; ++y) {
      for (int x = 0; x < kShadow; ++x) {
        float sum = 0;
        for (int k = -kReach; k <= kReach; ++k) {
          const int sx = std::clamp(x + k * dx, 0, kShadow - 1), sy = std::clamp(y + k * dy, 0, kShadow - 1);
          sum += shadow_[static_cast<std::size_t>(sy * kShadow + sx)];
        }
        blurred[static_cast<std::size_t>(y * kShadow + x)] = sum / (2 * kReach + 1);
      }
    }
    shadow_.swap(blurred);
  }
}

Colour Renderer::background(int x, int y) const {
  if (options_.bare) return colour(0xffffff);
  const float down = static_cast<float>(y) / static_cast<float>(solid_.layer.height());
  Colour c = mix(colour(0xfdfdfe), colour(0xe3e8ee), down * down);
  const Vec3 ray = projection_.ray(x + 0.5, y + 0.5);
  if (!(ray.y < -1e-6)) return c;
  const Vec3 hit = projection_.eye() + ((ground_y_ - projection_.eye().y) / ray.y) * ray;
  const double u = (hit.x - shadow_centre_.x) / shadow_half_, v = (hit.z - shadow_centre_.z) / shadow_half_;
  if (!(std::abs(u) < 0.99 && std::abs(v) < 0.99)) return c;
  const auto cell = [](double t) { return static_cast<int>((t + 1) * 0.5 * kShadow); };
  return mix(c, colour(0x2b3440), 0.38f * shadow_[static_cast<std::size_t>(cell(v) * kShadow + cell(u))]);
}

// Key light from the upper left of the viewer, a weak fill from the right, light from the sky, and a highlight.
Colour Renderer::shade(Colour base, const Surfel& surfel, int x, int y, float gloss) const {
  const Vec3 view = unit_or(-projection_.ray(x + 0.5, y + 0.5), {0, 0, 1});
  Vec3 n = unit_or({double(surfel.normal[0]), double(surfel.normal[1]), double(surfel.normal[2])}, view);
  if (dot(n, view) < 0) n = -n;
  const double light =
      0.44 + 0.50 * std::max(0.0, dot(n, key_)) + 0.14 * std::max(0.0, dot(n, fill_)) + 0.10 * dot(n, kWorldUp);
  const double facing = dot(n, unit_or(key_ + view, view));
  const double highlight = facing > 0.5 ? std::pow(facing, 48.0) : 0;  // 4e-15 there
  const auto lit = static_cast<float>(light), shine = gloss * static_cast<float>(highlight);
  return {base.r * lit + shine, base.g * lit + shine, base.b * lit + shine};
}

Colour Renderer::solid_colour(int x, int y) const {
  const Surfel& surfel = solid_.layer.at(x, y);
  if (surfel.material == kAnchorFree) return shade(colour(0x2f6f8f), surfel, x, y, 0.35f);
  if (surfel.material == kAnchorFixed) return shade(colour(0x3c434b), surfel, x, y, 0.35f);
  const Colour of_value = map_colour(static_cast<double>(surfel.value) / colours_.top);
  if (surfel.material == kAnchorStress) return shade(of_value, surfel, x, y, 0.35f);
  if (!on_surface_) return shade(kNoValue, surfel, x, y, 0.16f);
  const Colour c = shade(of_value, surfel, x, y, 0.16f);
  // Contour line where a neighbour lies beyond another legend tick.
  const auto band = [this](const Surfel& s) {
    return std::upper_bound(colours_.tick.begin(), colours_.tick.end(), static_cast<double>(s.value) / colours_.unit) -
           colours_.tick.begin();
  };
  for (const int step : {1, 2}) {
    if (x + step < solid_.layer.width() && solid_.layer.at(x + step, y).material == kBody &&
        band(solid_.layer.at(x + step, y)) != band(surfel)) {
      return mix(c, kInk, 0.35f);
    }
    if (y + step < solid_.layer.height() && solid_.layer.at(x, y + step).material == kBody &&
        band(solid_.layer.at(x, y + step)) != band(surfel)) {
      return mix(c, kInk, 0.35f);
    }
    if (step >= samples_) break;
  }
  return c;
}

// Opacity of the rest shape's dashed silhouette at a sample.
float Renderer::outline(int x, int y) const {
  if ((x + y) / (7 * samples_) % 2 != 0) return 0;
  const bool here = rest_.layer.at(x, y).material >= 0;
  for (int k = 1; k <= samples_; ++k) {
    if (x + k < rest_.layer.width() && (rest_.layer.at(x + k, y).material >= 0) != here) return 0.7f;
    if (y + k < rest_.layer.height() && (rest_.layer.at(x, y + k).material >= 0) != here) return 0.7f;
  }
  return 0;
}

Colour Renderer::sample(int x, int y) const {
  const Surfel& solid = solid_.layer.at(x, y);
  Colour c = solid.material >= 0 ? solid_colour(x, y) : background(x, y);
  c = mix(c, kGrey, outline(x, y));
  const Surfel& tool = tool_.layer.at(x, y);
  const Surfel& arrow = arrows_.layer.at(x, y);
  const auto over_arrow = [&] {
    if (arrow.material < 0) return;
    c = mix(c, shade(kArrowColour, arrow, x, y, 0.3f), arrow.depth_m < solid.depth_m ? 1.0f : 0.45f);
  };
  const auto over_tool = [&] {
    if (tool.material < 0) return;
    const Vec3 view = unit_or(-projection_.ray(x + 0.5, y + 0.5), {0, 0, 1});
    const Vec3 n = unit_or({double(tool.normal[0]), double(tool.normal[1]), double(tool.normal[2])}, view);
    const auto grazing = static_cast<float>(1 - std::abs(dot(n, view)));  // like glass: denser at the rim
    // A hand is skin, not glass: fingers before the body hide it.
    if (is_hand_) {
      const float opaque = tool.depth_m < solid.depth_m ? 0.93f : 0.16f;
      c = mix(c, shade(kSkinColour, tool, x, y, 0.10f), opaque);
      return;
    }
    const float opacity = tool.depth_m < solid.depth_m ? 0.38f + 0.5f * grazing * grazing : 0.10f + 0.25f * grazing;
    c = mix(c, shade(kToolColour, tool, x, y, 0.55f), opacity);
  };
  if (arrow.material >= 0 && arrow.depth_m < tool.depth_m) {
    over_tool(), over_arrow();
  } else {
    over_arrow(), over_tool();
  }
  return c;
}

Canvas Renderer::resolve() {
  Canvas canvas(options_.width, options_.height, colour(0xffffff));
  const float share = 1.0f / static_cast<float>(samples_ * samples_);
  for (int y = 0; y < options_.height; ++y) {
    if (y % kBand == 0)
      for (Sheet* sheet : {&solid_, &rest_, &tool_, &arrows_}) sheet->begin(y * samples_);
    for (int x = 0; x < options_.width; ++x) {
      Colour sum{};
      for (int k = 0; k < samples_ * samples_; ++k) {
        const Colour c = sample(x * samples_ + k % samples_, y * samples_ + k / samples_);
        sum.r += std::clamp(c.r, 0.0f, 1.0f), sum.g += std::clamp(c.g, 0.0f, 1.0f),
            sum.b += std::clamp(c.b, 0.0f, 1.0f);
      }
      canvas.set_pixel(x, y, {sum.r * share, sum.g * share, sum.b * share});
    }
  }
  return canvas;
}

void Renderer::draw_legend(Canvas& canvas) const {
  const double unit = options_.height / 900.0, left = options_.width - 96 * unit, top = 0.30 * options_.height;
  const double height = 0.40 * options_.height, width = 20 * unit;
  const char* const meaning = colour_meaning(model_, options_.colour);
  if (!solves(model_, options_.colour)) {
    canvas.text(options_.width - 30 * unit, top, fmt::format("{}: {}", colours_.name, meaning), 15 * unit, kInk,
                Align::kEnd);
    return;
  }
  const int rows = static_cast<int>(height);
  for (int row = 0; row < rows; ++row) canvas.rectangle(left, top + row, width, 1, map_colour(1 - (row + 0.5) / rows));
  const double x1 = left + width, y1 = top + rows;
  canvas.polyline(Stroke{{left, top}, {x1, top}, {x1, y1}, {left, y1}, {left, top}}, 1.2 * unit, kGrey);
  for (const double tick : colours_.tick) {
    const double y = y1 - rows * tick * colours_.unit / colours_.top;
    canvas.polyline(Stroke{{x1, y}, {x1 + 6 * unit, y}}, 1.2 * unit, kGrey);
    canvas.text(x1 + 11 * unit, y + 5.5 * unit, tick_label(tick), 15 * unit, kInk);
  }
  const auto middle_of = [&](const std::string& text) {  // within the picture
    return std::min(x1, options_.width - 10 * unit - 0.5 * text_width(text, 15 * unit));
  };
  canvas.text(middle_of(meaning), top + height + 24 * unit, meaning, 15 * unit, kGrey, Align::kMiddle);
  canvas.text(middle_of(colours_.name), top - 36 * unit, colours_.name, 15 * unit, kInk, Align::kMiddle);
  canvas.text(x1, top - 16 * unit, fmt::format("({})", colours_.unit_name), 15 * unit, kInk, Align::kMiddle);
}

// Beyond the arrow's tip, in the direction it points.
void Renderer::draw_force_labels(Canvas& canvas) const {
  const double unit = options_.height / 900.0, size = 18 * unit, gap = 9 * unit;
  // The largest first; a number that would cover one already there is left out (a hand has up to fifteen).
  struct Box {
    double x, y, width;  // of the number's middle
  };
  std::vector<Box> placed;
  for (const DrawnForce& force : forces_) {
    const Vec3 tail = (1.0 / samples_) * projection_(force.tail_w),
               tip = (1.0 / samples_) * projection_(force.tail_w + force_scale_.m_per_N * force.force_N);
    const Vec3 way = unit_or({tip.x - tail.x, tip.y - tail.y, 0}, {1, 0, 0});
    const std::string number = fmt::format("{:.2f} N", norm(force.force_N));
    const double width = text_width(number, size);
    const Box box{tip.x + way.x * (gap + 0.5 * width), tip.y + way.y * (gap + 0.5 * size), width};
    const auto covers = [&](const Box& other) {
      return std::abs(box.y - other.y) < size && std::abs(box.x - other.x) < 0.5 * (box.width + other.width);
    };
    if (std::ranges::any_of(placed, covers)) continue;
    placed.push_back(box);
    const double base = box.y + 0.36 * size;
    for (int k = 0; k < 8; ++k) {  // a light rim, to be read on arrows and skin
      const double angle = 0.25 * kPi * k, rim = 2 * unit;
      canvas.text(box.x + rim * std::cos(angle), base + rim * std::sin(angle), number, size, colour(0xfdfdfe),
                  Align::kMiddle, false, true);
    }
    canvas.text(box.x, base, number, size, kArrowColour, Align::kMiddle, false, true);
  }
}

void Renderer::draw_title(Canvas& canvas) const {
  const double unit = options_.height / 900.0;
  const ForceSum sum = force_sum(state_);
  canvas.text(36 * unit, 52 * unit, options_.title.empty() ? model_.name : options_.title, 26 * unit, kInk,
              Align::kStart, false, true);
  canvas.text(36 * unit, 82 * unit, fmt::format("{}    depth {:.2f} mm", force_words(sum), sum.depth_m * 1e3),
              17 * unit, kGrey);
  draw_legend(canvas);
}

}  // namespace

Canvas render_scene(const Model& model, const State& state, const DeformedSurface& surface,
                    const PictureOptions& options) {
  return Renderer(model, state, surface, options).render();
}

void save_picture(const std::string& path, const Model& model, const State& state, const PictureOptions& options) {
  const Canvas canvas = render_scene(model, state, refined_surface(model, state), options);
  write_png(path, canvas.width(), canvas.height(), canvas.bytes());
}

}  // namespace palpate
