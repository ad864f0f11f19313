#include "sim_host/viewer/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim_host/view/picture.h"
#include "sim_host/view/plot.h"
#include "sim_host/view/world_axes.h"
#include "sim_host/viewer/plots.h"

namespace palpate {

namespace {

class Overlay {
 public:
  Overlay(ImDrawList* list, ImVec2 low, ImVec2 size, const OrbitCamera& camera, const OverlayScene& scene,
          const Fonts& fonts)
      : list_(list),
        low_(low),
        size_(size),
        camera_(camera),
        scene_(scene),
        fonts_(fonts),
        projection_(camera.camera(), static_cast<int>(size.x), static_cast<int>(size.y)),
        unit_(fonts.text->FontSize) {}

  void draw() {
    title();
    if (scene_.layers.forces) force_numbers();
    colour_legend();
    foot();
    hand();
  }

 private:
  void text(ImFont* font, float size, ImVec2 at, Colour c, const std::string& text, float opacity = 1) {
    list_->AddText(font, size, at, packed(c, opacity), text.c_str());
  }
  ImVec2 number_extent(const std::string& text) const {
    return fonts_.title->CalcTextSizeA(unit_, 1e9f, 0, text.c_str());
  }
  ImVec2 extent(float size, const std::string& text) const {
    return fonts_.text->CalcTextSizeA(size, 1e9f, 0, text.c_str());
  }
  ImVec2 on_screen(Vec3 point_w) const {
    const Vec3 p = projection_(point_w);
    return {low_.x + static_cast<float>(p.x), low_.y + static_cast<float>(p.y)};
  }

  void title() {
    const float x = low_.x + 1.4f * unit_, y = low_.y + 1.0f * unit_, large = fonts_.title->FontSize;
    const float beside = scene_.letter.empty() ? 0 : 1.4f * large;
    if (beside > 0) {
      const ImVec2 room = fonts_.title->CalcTextSizeA(0.8f * large, 1e9f, 0, scene_.letter.c_str());
      list_->AddRectFilled({x, y + 0.02f * large}, {x + large, y + 1.02f * large}, packed(scene_.letter_colour), 4);
      text(fonts_.title, 0.8f * large, {x + 0.5f * (large - room.x), y + 0.12f * large}, theme::kPaper, scene_.letter);
    }
    text(fonts_.title, large, {x + beside, y}, theme::kInk, scene_.title);
    text(fonts_.text, unit_, {x, y + 1.15f * large}, theme::kGrey, scene_.line);
    if (scene_.notice.empty()) return;
    const ImVec2 room = extent(unit_, scene_.notice);
    const ImVec2 at{low_.x + 0.5f * (size_.x - room.x), low_.y + size_.y - 6.6f * unit_};
    list_->AddRectFilled({at.x - 0.8f * unit_, at.y - 0.4f * unit_},
                         {at.x + room.x + 0.8f * unit_, at.y + 1.4f * unit_}, packed(theme::kPaper, 0.92f),
                         0.5f * unit_);
    text(fonts_.text, unit_, at, theme::kInk, scene_.notice);
  }

  // Strong and with a light rim, to be read over anything.
  void number(ImVec2 at, Colour c, const std::string& what) {
    for (int k = 0; k < 8; ++k) {
      const float angle = 0.785398f * static_cast<float>(k), rim = 0.10f * unit_;
      text(fonts_.title, unit_, {at.x + rim * std::cos(angle), at.y + rim * std::sin(angle)}, theme::kPaper, what);
    }
    text(fonts_.title, unit_, at, c, what);
  }

  // Beyond the arrow's tip, in its direction; what would cover a number already there is left out.
  void label_arrow(Vec3 tail_w, Vec3 force_N, Colour c) {
    const ImVec2 tail = on_screen(tail_w), tip = on_screen(tail_w + scene_.forces.m_per_N * force_N);
    const float dx = tip.x - tail.x, dy = tip.y - tail.y, length = std::max(1.0f, std::hypot(dx, dy));
    const std::string what = fmt::format("{:.2f} N", norm(force_N));
    const ImVec2 room = number_extent(what);
    const float reach = 0.45f * unit_ + 0.5f * (std::abs(dx) * room.x + std::abs(dy) * room.y) / length;
    ImVec2 middle{tip.x + dx / length * reach, tip.y + dy / length * reach};
    const Bar bar = legend_bar();
    const float nearest = bar.left - 1.2f * unit_ - 0.5f * room.x;  // not under the colours
    if (middle.y > bar.top - 3 * unit_ && middle.y < bar.top + bar.height + 2 * unit_)
      middle.x = std::min(middle.x, nearest);
    for (const ImVec2 other : placed_)
      if (std::abs(other.y - middle.y) < unit_ && std::abs(other.x - middle.x) < room.x) return;
    placed_.push_back(middle);
    number({middle.x - 0.5f * room.x, middle.y - 0.5f * room.y}, c, what);
  }

  void force_numbers() {
    // Of a whole hand only what counts: the rest are arrows alone.
    constexpr double kWorthANumber = 0.2;
    constexpr double kLeastNumber_N = 0.005;  // less is written 0.00
    const std::vector<DrawnForce> forces = drawn_forces(*scene_.state);
    for (const DrawnForce& force : forces) {
      const double least_N = kWorthANumber * norm(forces.front().force_N);
      if (norm(force.force_N) >= std::max(least_N, kLeastNumber_N))
        label_arrow(force.tail_w, force.force_N, theme::kForce);
      if (forces.size() <= 3 && norm(force.friction_N) > std::max(0.04 * norm(force.force_N), kLeastNumber_N))
        label_arrow(force.tail_w, force.friction_N, theme::kFriction);
    }
  }

  struct Bar {
    float left, top, height;
  };
  Bar legend_bar() const {
    const float height = std::min(0.42f * size_.y, 22 * unit_);
    return {low_.x + size_.x - 4.4f * unit_, low_.y + 0.5f * (size_.y - height), height};
  }

  void colour_legend() {
    const auto [left, top, height] = legend_bar();
    const float width = 1.0f * unit_, middle = left + 0.8f * width;
    const ColourScale& colours = scene_.colours;
    const char* const kind = colour_meaning(*scene_.model, colours.shown);
    if (!solves(*scene_.model, colours.shown)) {
      centred(middle, top - 2.6f * unit_, theme::kInk, colours.name);
      centred(middle, top - 1.3f * unit_, theme::kWarning, kind);
      return;
    }
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
      const auto y = [&](int k) { return top + height * static_cast<float>(k) / kSteps; };
      list_->AddRectFilledMultiColor({left, y(i)}, {left + width, y(i + 1)}, step(i), step(i), step(i + 1),
                                     step(i + 1));
    }
    list_->AddRect({left, top}, {left + width, top + height}, packed(theme::kGrey, 0.6f));
    for (const double tick : colours.tick) {
      const float y = top + height * static_cast<float>(1 - tick * colours.unit / colours.top);
      list_->AddLine({left + width, y}, {left + 1.3f * width, y}, packed(theme::kGrey));
      text(fonts_.text, 0.9f * unit_, {left + 1.6f * width, y - 0.5f * unit_}, theme::kInk, tick_label(tick));
    }
    centred(middle, top + height + 0.6f * unit_, theme::kGrey, kind);
    centred(middle, top - 2.6f * unit_, theme::kInk, colours.name);
    centred(middle, top - 1.45f * unit_, theme::kInk, fmt::format("({})", colours.unit_name));
  }
  // About `middle`, but within the scene.
  void centred(float middle, float y, Colour c, const std::string& what) {
    const ImVec2 room = number_extent(what);
    const float most = low_.x + size_.x - room.x - 0.6f * unit_;
    number({std::min(middle - 0.5f * room.x, most), y}, c, what);
  }
  static ImU32 step(int i) { return packed(map_colour(1 - i / 64.0)); }

  // Axes, length and force to scale, left below.
  void foot() {
    const float base = low_.y + size_.y - 2.0f * unit_;
    axes({low_.x + 3.6f * unit_, base - 1.6f * unit_});
    const double m_per_pixel =
        2 * camera_.distance_m() * std::tan(0.5 * camera_.camera().vertical_fov_rad) / static_cast<double>(size_.y);
    const double bar_m = round_below(static_cast<double>(8 * unit_) * m_per_pixel);
    float x = low_.x + 8.5f * unit_;
    const float bar = static_cast<float>(bar_m / m_per_pixel);
    for (const float end : {x, x + bar})
      list_->AddLine({end, base - 0.3f * unit_}, {end, base + 0.3f * unit_}, packed(theme::kInk), 1.6f);
    list_->AddLine({x, base}, {x + bar, base}, packed(theme::kInk), 1.6f);
    text(fonts_.text, 0.9f * unit_, {x, base - 1.6f * unit_}, theme::kInk, tick_label(1e3 * bar_m) + " mm");
    x += std::max(bar, 5 * unit_) + 3 * unit_;
    if (scene_.layers.forces) force_key(x, base, m_per_pixel);
  }

  void force_key(float x, float base, double m_per_pixel) {
    const auto arrow = static_cast<float>(scene_.forces.reference_N * scene_.forces.m_per_N / m_per_pixel);
    const auto one = [&](float at, Colour c, const std::string& what) {
      const float head = std::min(0.5f * arrow, 0.7f * unit_);
      list_->AddLine({at, base}, {at + arrow - head, base}, packed(c), 0.28f * unit_);
      list_->AddTriangleFilled({at + arrow, base}, {at + arrow - head, base - 0.38f * unit_},
                               {at + arrow - head, base + 0.38f * unit_}, packed(c));
      text(fonts_.text, 0.9f * unit_, {at, base - 1.6f * unit_}, theme::kInk, what);
      return at + std::max(arrow, extent(0.9f * unit_, what).x) + 2 * unit_;
    };
    const std::string amount = tick_label(scene_.forces.reference_N) + " N";
    x = one(x, theme::kForce, amount + " on the tool");
    one(x, theme::kFriction, amount + " by friction");
  }

  void axes(ImVec2 centre) {
    for (const WorldAxis& a : world_axes(projection_)) {
      const auto x = static_cast<float>(a.right), y = static_cast<float>(a.down);
      const ImVec2 tip{centre.x + 2.0f * unit_ * x, centre.y + 2.0f * unit_ * y};
      list_->AddLine(centre, tip, packed(a.colour), 2.2f);
      list_->AddCircleFilled(tip, 3.0f, packed(a.colour));
      const ImVec2 room = extent(0.9f * unit_, a.name);
      text(fonts_.text, 0.9f * unit_,
           {centre.x + 2.7f * unit_ * x - 0.5f * room.x, centre.y + 2.7f * unit_ * y - 0.5f * room.y}, a.colour,
           a.name);
    }
  }

  // A spring from the place of the tool that is held to where the mouse pulls it.
  void hand() {
    if (!scene_.hand_m || !scene_.held_m) return;
    const ImVec2 from = on_screen(*scene_.held_m), to = on_screen(*scene_.hand_m);
    const float length = std::hypot(to.x - from.x, to.y - from.y);
    const double lag_m = norm(*scene_.hand_m - *scene_.held_m);
    list_->AddCircle(to, 0.55f * unit_, packed(theme::kFelt), 32, 2.0f);
    if (length < unit_) return;
    std::vector<ImVec2> coil;
    constexpr int kTurns = 24;
    for (int i = 0; i <= kTurns; ++i) {
      const float s = static_cast<float>(i) / kTurns, off = i < 2 || i > kTurns - 2 ? 0 : (i % 2 == 0 ? 0.28f : -0.28f);
      coil.push_back({from.x + s * (to.x - from.x) - off * unit_ * (to.y - from.y) / length,
                      from.y + s * (to.y - from.y) + off * unit_ * (to.x - from.x) / length});
    }
    list_->AddPolyline(coil.data(), static_cast<int>(coil.size()), packed(theme::kFelt, 0.9f), 0, 1.6f);
    number({to.x + 0.9f * unit_, to.y - 0.5f * unit_}, theme::kFelt, fmt::format("{:.1f} mm", 1e3 * lag_m));
  }

  ImDrawList* list_;
  ImVec2 low_, size_;
  const OrbitCamera& camera_;
  const OverlayScene& scene_;
  const Fonts& fonts_;
  Projection projection_;
  float unit_;
  std::vector<ImVec2> placed_;
};

}  // namespace

void draw_overlay(ImDrawList* list, ImVec2 low, ImVec2 size, const OrbitCamera& camera, const OverlayScene& scene,
                  const Fonts& fonts) {
  Overlay(list, low, size, camera, scene, fonts).draw();
}

}  // namespace palpate
