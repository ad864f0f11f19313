// Boundary elements of a half space: frictionless contact with a rigid tool of any shape.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace palpate::test {

// Mean displacement of a rectangle's middle, E* = 1, under unit pressure on another, (x, y) away (Love 1929).
inline double love(double x, double y, double half_x, double half_y) {
  const auto part = [](double u, double v) {
    const double r = std::hypot(u, v);
    return v * std::log(u + r) + u * std::log(v + r);
  };
  return (part(x + half_x, y + half_y) - part(x - half_x, y + half_y) - part(x + half_x, y - half_y) +
          part(x - half_x, y - half_y)) /
         std::numbers::pi;
}

// Frictionless contact on a half space of E* = 1: rectangles under constant pressure, conjugate gradients that never
// pull (Polonsky & Keer 1999).
class HalfSpace {
 public:
  HalfSpace(int nx, int ny, double half_width, double from, double to)
      : nx_(nx), ny_(ny), dx_(2 * half_width / nx), dy_((to - from) / ny), x0_(-half_width), y0_(from) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) kernel_.push_back(love(i * dx_, j * dy_, 0.5 * dx_, 0.5 * dy_));
  }
  struct Load {
    double force = 0, moment = 0;
  };
  // How far the tool overlaps the flat body at (x, y).
  Load press(const std::function<double(double, double)>& overlap) const {
    const std::size_t n = kernel_.size();
    std::vector<double> depth(n), p(n), rest(n), way(n, 0.0), moved(n);
    for (std::size_t k = 0; k < n; ++k) {
      depth[k] = overlap(x(k), y(k));
      p[k] = 0.5 * std::max(depth[k], 0.0);
    }
    double before = 1, keep = 0;
    for (int step = 0; step < 300; ++step) {
      show(p, moved);
      double square = 0;
      for (std::size_t k = 0; k < n; ++k) {
        rest[k] = moved[k] - depth[k];
        square += p[k] > 0 ? rest[k] * rest[k] : 0.0;
      }
      for (std::size_t k = 0; k < n; ++k) way[k] = p[k] > 0 ? rest[k] + keep * square / before * way[k] : 0.0;
      before = square;
      show(way, moved);
      double above = 0, below = 0, whole = 0, changed = 0;
      for (std::size_t k = 0; k < n; ++k) {
        above += rest[k] * way[k];
        below += moved[k] * way[k];
      }
      const double length = above / below;
      keep = 1;
      for (std::size_t k = 0; k < n; ++k) {
        const double last = p[k];
        p[k] = std::max(p[k] - length * way[k], 0.0);
        if (p[k] == 0 && rest[k] < 0) {
          p[k] = -length * rest[k];
          keep = 0;
        }
        changed += std::abs(p[k] - last);
        whole += p[k];
      }
      if (changed < 1e-6 * whole) break;
    }
    Load load;
    for (std::size_t k = 0; k < n; ++k) {
      load.force += p[k] * dx_ * dy_;
      load.moment += p[k] * dx_ * dy_ * y(k);
    }
    return load;
  }

 private:
  double x(std::size_t k) const { return x0_ + dx_ * (0.5 + static_cast<double>(k % static_cast<std::size_t>(nx_))); }
  double y(std::size_t k) const { return y0_ + dy_ * (0.5 + static_cast<double>(k / static_cast<std::size_t>(nx_))); }
  void show(const std::vector<double>& p, std::vector<double>& moved) const {
    std::fill(moved.begin(), moved.end(), 0.0);
    for (int b = 0; b < ny_; ++b)
      for (int a = 0; a < nx_; ++a) {
        const double from = p[static_cast<std::size_t>(b * nx_ + a)];
        if (from == 0) continue;
        for (int j = 0; j < ny_; ++j) {
          const double* row = &kernel_[static_cast<std::size_t>(std::abs(j - b) * nx_)];
          double* out = &moved[static_cast<std::size_t>(j * nx_)];
          for (int i = 0; i < nx_; ++i) out[i] += from * row[std::abs(i - a)];
        }
      }
  }
  int nx_, ny_;
  double dx_, dy_, x0_, y0_;
  std::vector<double> kernel_;
};

}  // namespace palpate::test
