// Bodies with a hole: half shell, ring, hollow cylinder.
#include <algorithm>
#include <cmath>

#include "config/body/procedural.h"
#include "config/index.h"

namespace palpate {

namespace {

// Cells around the axis and rows along the profile, 2 x around x rows triangles: as many as asked for, nearly square,
// and such that mirror images fit.
struct Cells {
  std::int32_t around = 8, rows = 4;
};
Cells cells_for(std::int32_t triangles, double around_m, double profile_m, std::int32_t row_multiple) {
  const double ideal = std::sqrt(0.5 * triangles * around_m / profile_m);
  Cells best;
  double least = kHuge;
  const auto from = std::max(8, static_cast<std::int32_t>(0.6 * ideal)),
             to = static_cast<std::int32_t>(1.6 * ideal) + 9;
  for (std::int32_t around = from + from % 2; around <= to; around += 2) {
    const double rows = std::round(0.5 * triangles / around / row_multiple) * row_multiple;
    if (rows < 4) continue;
    const double wrong = std::abs(2 * around * rows / triangles - 1);
    // One per cent of triangles weighs as much as cells a quarter longer than wide, or a lost mirror plane.
    const double price = 20 * wrong + std::abs(std::log(around / ideal)) + (around % 4 == 0 ? 0 : 0.2);
    if (price < least - 1e-9) {
      least = price;
      best = {around, static_cast<std::int32_t>(rows)};
    }
  }
  return best;
}

// cos and sin of 2 pi k / n with the symmetries of the circle kept to the bit.
struct Direction {
  double c, s;
};
Direction direction(std::int32_t k, std::int32_t n) {
  const std::int32_t eighth = (8 * k) / n;  // octant
  const auto angle = [&](std::int32_t numerator) { return 2 * kPi * numerator / (4 * n); };
  // Multiples of pi/2n within the first octant; the others by reflection.
  const std::int32_t q = 4 * k;  // of 4n
  switch (eighth) {
    case 0:
      return {std::cos(angle(q)), std::sin(angle(q))};
    case 1:
      return {std::sin(angle(n - q)), std::cos(angle(n - q))};
    case 2:
      return {-std::sin(angle(q - n)), std::cos(angle(q - n))};
    case 3:
      return {-std::cos(angle(2 * n - q)), std::sin(angle(2 * n - q))};
    case 4:
      return {-std::cos(angle(q - 2 * n)), -std::sin(angle(q - 2 * n))};
    case 5:
      return {-std::sin(angle(3 * n - q)), -std::cos(angle(3 * n - q))};
    case 6:
      return {std::sin(angle(q - 3 * n)), -std::cos(angle(q - 3 * n))};
    default:
      return {std::cos(angle(4 * n - q)), -std::sin(angle(4 * n - q))};
  }
}

// Rings of vertices joined by rows of cells. Profiles run counter-clockwise with the axis to the left: up outside, down
// inside.
class Sweep {
 public:
  Sweep(SurfaceMesh& mesh, std::int32_t around) : mesh_(mesh), around_(around) {}
  // First vertex of a new ring; `place(c, s)` gives the point in the direction (c, s) around the axis.
  template <class Place>
  std::int32_t ring(Place place) {
    const auto first = static_cast<std::int32_t>(mesh_.vertex_m.size());
    for (std::int32_t k = 0; k < around_; ++k) {
      const Direction d = direction(k, around_);
      mesh_.vertex_m.push_back(place(d.c, d.s));
    }
    return first;
  }
  // Cells between a ring and the next along the profile. `upper`: in the mirror-image half of a symmetric profile.
  void row(std::int32_t ring, std::int32_t next, bool upper) {
    for (std::int32_t k = 0; k < around_; ++k) {
      const std::int32_t l = (k + 1) % around_;
      const std::int32_t a = ring + k, b = ring + l, c = next + l, d = next + k;
      if (turned(k) != upper) {
        mesh_.triangle.push_back({a, b, c});
        mesh_.triangle.push_back({a, c, d});
      } else {
        mesh_.triangle.push_back({a, b, d});
        mesh_.triangle.push_back({b, c, d});
      }
    }
  }

 private:
  // Diagonals are mirror images across the axes of the circle.
  bool turned(std::int32_t k) const {
    const Direction d = direction(2 * k + 1, 2 * around_);
    return around_ % 4 == 0 ? d.c * d.s > 0 : d.s > 0;
  }
  SurfaceMesh& mesh_;
  std::int32_t around_;
};

// Rows from pole to rim and across the rim of a half shell: 12 dome (dome + rim) triangles. An even number of rows
// keeps both mirror planes.
struct ShellRows {
  std::int32_t dome = 4, rim = 1;
};
ShellRows shell_rows_for(std::int32_t triangles, double around_m, double wall_m) {
  ShellRows best;
  double least = kHuge;
  for (std::int32_t dome = 4; 12 * dome * dome < triangles; dome += 2) {
    const auto rim = static_cast<std::int32_t>(std::round(triangles / (12.0 * dome) - dome));
    if (rim < 1) continue;
    const double wrong = std::abs(12.0 * dome * (dome + rim) / triangles - 1);
    const double price = 20 * wrong + std::abs(std::log(wall_m / rim / (around_m / (6 * dome))));
    if (price < least) {
      least = price;
      best = {dome, rim};
    }
  }
  return best;
}

// A dome as a triangular grid: ring j around the pole has 6 j vertices, and every vertex about 6 neighbours. A fan of
// meridians would make the search for the closest point look at all of them: 35,000 instead of 5,000 instructions on a
// pole of 64 (measured 2026-11-21). `place(j, c, s)`: the point of ring j in direction (c, s). Returns the first vertex
// of the last ring. `inside`: seen from below.
template <class Place>
std::int32_t dome(SurfaceMesh& mesh, std::int32_t rows, bool inside, Place place) {
  const auto pole = static_cast<std::int32_t>(mesh.vertex_m.size());
  mesh.vertex_m.push_back(place(0, 1, 0));
  const auto vertex = [pole](std::int32_t j, std::int32_t k) {
    return j == 0 ? pole : pole + 1 + 3 * j * (j - 1) + k % (6 * j);
  };
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    mesh.triangle.push_back(inside ? Corners{b, a, c} : Corners{a, b, c});
  };
  for (std::int32_t j = 1; j <= rows; ++j) {
    for (std::int32_t k = 0; k < 6 * j; ++k) {
      const Direction d = direction(k, 6 * j);
      mesh.vertex_m.push_back(place(j, d.c, d.s));
    }
    for (std::int32_t sector = 0; sector < 6; ++sector) {
      for (std::int32_t i = 0; i < j; ++i) {
        const std::int32_t out = sector * j + i, in = sector * (j - 1) + i;
        add(vertex(j, out), vertex(j, out + 1), vertex(j - 1, in));
        if (i + 1 < j) add(vertex(j, out + 1), vertex(j - 1, in + 1), vertex(j - 1, in));
      }
    }
  }
  return vertex(rows, 0);
}

Vec3 around_axis(BodyAxis axis, double radial_c, double radial_s, double along) {
  // Right-handed both ways; the mirror image that every number of cells has, of the sine, is that of x.
  return axis == BodyAxis::kZ ? Vec3{radial_s, radial_c, -along} : Vec3{radial_s, along, radial_c};
}

void stand(SurfaceMesh& mesh) {
  const double lowest = bounds_of(mesh).lower_m.y;
  for (Vec3& p : mesh.vertex_m) p.y -= lowest;
}

}  // namespace

SurfaceMesh make_half_shell(Vec3 half, double wall_m, std::int32_t triangles) {
  const Vec3 inner{half.x - wall_m, half.y - wall_m, half.z - wall_m};
  const ShellRows rows = shell_rows_for(triangles, kPi * (half.x + half.z - wall_m), wall_m);
  SurfaceMesh mesh;
  const auto dome_on = [&](Vec3 axes, bool inside) {
    return dome(mesh, rows.dome, inside, [&](std::int32_t j, double c, double s) {
      const double angle = 0.5 * kPi * j / rows.dome, r = std::sin(angle);
      const double h = j == rows.dome ? 0.0 : std::cos(angle);
      return Vec3{axes.x * r * s, axes.y * h, axes.z * r * c};
    });
  };
  const std::int32_t first = dome_on(half, false);
  std::int32_t last = dome_on(inner, true);
  Sweep sweep(mesh, 6 * rows.dome);
  for (std::int32_t i = 1; i < rows.rim; ++i) {
    const double f = static_cast<double>(i) / rows.rim;
    const double x = inner.x + f * wall_m, z = inner.z + f * wall_m;
    const std::int32_t next = sweep.ring([&](double c, double s) { return Vec3{x * s, 0, z * c}; });
    sweep.row(last, next, false);
    last = next;
  }
  sweep.row(last, first, false);
  return mesh;
}

SurfaceMesh make_ring(double radius_m, double wall_m, BodyAxis axis, std::int32_t triangles) {
  const double tube = 0.5 * wall_m, centre = radius_m - tube;
  // A lying ring has a row at its lowest place, whatever the number of triangles: with 14 rows the elements of a torus,
  // whose surface has 28, stood 0.3 mm lower than that (2026-11-26).
  const Cells cells = cells_for(triangles, 2 * kPi * centre, kPi * wall_m, axis == BodyAxis::kZ ? 2 : 4);
  SurfaceMesh mesh;
  Sweep sweep(mesh, cells.around);
  for (std::int32_t i = 0; i < cells.rows; ++i) {
    const Direction d = direction(i, cells.rows);
    sweep.ring([&](double c, double s) {
      const double r = centre + tube * d.c;
      return around_axis(axis, r * c, r * s, tube * d.s);
    });
  }
  for (std::int32_t i = 0; i < cells.rows; ++i)
    sweep.row(i * cells.around, (i + 1) % cells.rows * cells.around, 2 * i < cells.rows);
  stand(mesh);
  return mesh;
}

SurfaceMesh make_hollow_cylinder(double radius_m, double wall_m, double height_m, BodyAxis axis,
                                 std::int32_t triangles) {
  const double middle = radius_m - 0.5 * wall_m;
  const Cells cells = cells_for(triangles, 2 * kPi * middle, 2 * (height_m + wall_m), 2);
  const std::int32_t half = cells.rows / 2;
  // An even number of rows up the wall leaves none across the middle plane.
  const auto side = std::max(2, 2 * static_cast<std::int32_t>(std::round(0.5 * half * height_m / (height_m + wall_m))));
  const std::int32_t rim = std::max(1, half - side);
  std::vector<ProfilePoint> profile;
  const double inner = radius_m - wall_m;
  const auto height = [&](std::int32_t i) { return 0.5 * height_m * (2 * i - side) / side; };
  for (std::int32_t i = 0; i < side; ++i) profile.push_back({radius_m, height(i)});
  for (std::int32_t i = 0; i < rim; ++i) profile.push_back({radius_m - wall_m * i / rim, height(side)});
  for (std::int32_t i = 0; i < side; ++i) profile.push_back({inner, height(side - i)});
  for (std::int32_t i = 0; i < rim; ++i) profile.push_back({radius_m - wall_m * (rim - i) / rim, height(0)});
  SurfaceMesh mesh;
  Sweep sweep(mesh, cells.around);
  for (const ProfilePoint& p : profile)
    sweep.ring([&](double c, double s) { return around_axis(axis, p.radius_m * c, p.radius_m * s, p.height_m); });
  const auto rings = static_cast<std::int32_t>(profile.size());
  for (std::int32_t i = 0; i < rings; ++i) {
    const std::int32_t next = (i + 1) % rings;
    sweep.row(i * cells.around, next * cells.around, profile[at(i)].height_m + profile[at(next)].height_m > 0);
  }
  stand(mesh);
  return mesh;
}

}  // namespace palpate
