// Reads measured force curves. Every refusal names file, line, what is wrong and what to do.
#include <charconv>
#include <fstream>
#include <sstream>

#include "config/response/table_bake.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

class CurveReader {
 public:
  CurveReader(const std::string& path, bool smooth) : path_(path), smooth_(smooth) {}

  std::vector<ForceCurve> read() {
    std::ifstream stream(path_);
    if (!stream) throw ConfigError(path_ + ": cannot be read; check path and permissions");
    std::string text;
    while (std::getline(stream, text)) {
      ++line_;
      text = trimmed(text);
      if (text.empty() || text[0] == '#') continue;
      if (columns_ == 0)
        read_header(text);
      else
        read_row(text);
    }
    if (columns_ == 0) throw ConfigError(path_ + ": empty; " + kFormat);
    if (curves_.empty()) throw ConfigError(path_ + ": no rows after the header; " + kFormat);
    finish();
    return curves_;
  }

 private:
  static constexpr const char* kFormat =
      "write a header \"depth_mm,force_N\" (or with x_mm,y_mm,z_mm before it) and rows";

  [[noreturn]] void fail(const std::string& what) const {
    throw ConfigError(path_ + ":" + std::to_string(line_) + ": " + what);
  }

  void read_header(const std::string& text) {
    std::string plain;
    for (const char c : text)
      if (c != ' ' && c != '\t' && c != '"') plain += c;
    if (plain == "depth_mm,force_N")
      columns_ = 2;
    else if (plain == "x_mm,y_mm,z_mm,depth_mm,force_N")
      columns_ = 5;
    else
      fail("unknown header '" + text + "'; " + kFormat);
  }

  std::vector<double> numbers(const std::string& text) const {
    std::vector<double> values;
    std::istringstream row(text);
    std::string field;
    while (std::getline(row, field, ',')) {
      field = trimmed(field);
      double value = 0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
      if (error != std::errc() || end != field.data() + field.size()) fail("'" + field + "' is not a number");
      if (!(value > -1e9 && value < 1e9)) fail(field + " is out of range; allowed finite numbers below 1e9");
      values.push_back(value);
    }
    if (values.size() != columns_)
      fail(std::to_string(values.size()) + " fields; the header names " + std::to_string(columns_));
    return values;
  }

  void read_row(const std::string& text) {
    const std::vector<double> v = numbers(text);
    const bool placed = columns_ == 5;
    const Vec3 position = placed ? Vec3{1e-3 * v[0], 1e-3 * v[1], 1e-3 * v[2]} : Vec3{};
    if (curves_.empty() || (placed && !(curves_.back().position_m == position))) {
      finish();
      for (const ForceCurve& other : curves_)
        if (other.position_m == position) fail("a press at this place has ended above; keep its rows together");
      curves_.push_back({placed, position, {}, {}});
    }
    append(curves_.back(), v[columns_ - 2], v[columns_ - 1]);
  }

  void append(ForceCurve& curve, double depth_mm, double force_N) const {
    const std::string row = "depth " + number_text(depth_mm) + " mm, force " + number_text(force_N) + " N";
    if (curve.depth_m.empty() && (depth_mm != 0 || force_N != 0))
      fail("the press starts at " + row +
           "; its first row must be 0,0: subtract the force before contact, and the depth "
           "of first contact");
    if (!curve.depth_m.empty() && !(1e-3 * depth_mm > curve.depth_m.back()))
      fail(row +
           ": the depth does not grow; sort the rows by depth, keep the loading half of the press and average "
           "repeated depths");
    if (!curve.force_N.empty() && !smooth_ && !(force_N >= curve.force_N.back()))
      fail(row +
           ": the force falls as the depth grows; remove the noise, or set contact.table.smooth = true to pool "
           "such rows");
    curve.depth_m.push_back(1e-3 * depth_mm);
    curve.force_N.push_back(force_N);
  }

  // Checks the press that has just ended and, if asked, makes it monotone.
  void finish() {
    if (curves_.empty()) return;
    ForceCurve& curve = curves_.back();
    if (curve.depth_m.size() < 2) fail("the press before this line has only its zero row; add at least one more");
    if (smooth_) pool(curve.force_N);
  }

  // Pool adjacent violators: the closest non-decreasing sequence (Ayer et al. 1955), kept at zero at the start.
  static void pool(std::vector<double>& force) {
    std::vector<double> mean;
    std::vector<std::size_t> count;
    for (std::size_t i = 0; i < force.size(); ++i) {
      mean.push_back(i == 0 ? 0 : std::max(force[i], 0.0));
      count.push_back(1);
      while (mean.size() > 2 && mean[mean.size() - 2] > mean.back()) {
        const double n = static_cast<double>(count[count.size() - 2]), m = static_cast<double>(count.back());
        mean[mean.size() - 2] = (n * mean[mean.size() - 2] + m * mean.back()) / (n + m);
        count[count.size() - 2] += count.back();
        mean.pop_back();
        count.pop_back();
      }
    }
    std::size_t next = 0;
    for (std::size_t k = 0; k < mean.size(); ++k)
      for (std::size_t i = 0; i < count[k]; ++i) force[next++] = mean[k];
  }

  std::string path_;
  bool smooth_;
  std::size_t columns_ = 0;
  int line_ = 0;
  std::vector<ForceCurve> curves_;
};

}  // namespace

std::vector<ForceCurve> read_curves(const std::string& path, bool smooth) { return CurveReader(path, smooth).read(); }

}  // namespace palpate
