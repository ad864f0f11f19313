#include "sim_host/view/view_script.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "sim_host/run/settings_port.h"

namespace palpate {

namespace {

using Kind = ViewStep::Kind;

struct Word {
  const char* name;
  const char* rest;  // what follows it
  Kind kind;
};
constexpr Word kWords[] = {{"wait", "SECONDS", Kind::kWait},
                           {"drag", "X_mm Y_mm Z_mm SECONDS", Kind::kDrag},
                           {"release", "", Kind::kRelease},
                           {"close", "SECONDS [FINGER | JOINT]", Kind::kClose},
                           {"open", "SECONDS [FINGER | JOINT]", Kind::kOpen},
                           {"joint", "JOINT=VALUE", Kind::kJoint},
                           {"free", "JOINT", Kind::kFree},
                           {"switch", "SCENE | IMAGE | . [OVERLAY...] [KEY=VALUE...]", Kind::kSwitch},
                           {"refused", "the same, of a scene that does not fit", Kind::kRefused},
                           {"list", "", Kind::kList},
                           {"set", "SETTING=FACTOR", Kind::kSet},
                           {"scrub", "SECONDS", Kind::kScrub},
                           {"follow", "", Kind::kFollow},
                           {"look", "VIEW", Kind::kLook},
                           {"colour", "displacement | pressure | stress", Kind::kColour},
                           {"fit", "", Kind::kFit},
                           {"turn", "DEGREES_right DEGREES_up", Kind::kTurn},
                           {"zoom", "STEPS", Kind::kZoom},
                           {"picture", "FILE.png", Kind::kPicture}};

// Reads one line's values; each says what is wrong with it.
class LineReader {
 public:
  explicit LineReader(const std::string& line) : words_(line) {}
  std::string word(const char* what) {
    std::string text;
    if (!(words_ >> text)) throw std::runtime_error(fmt::format("{} is missing", what));
    return text;
  }
  double number(const char* what, double lowest, double highest) {
    const std::string text = word(what);
    std::size_t used = 0;
    double value = std::nan("");
    try {
      value = std::stod(text, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != text.size() || !(value >= lowest && value <= highest))
      throw std::runtime_error(
          fmt::format("{} is '{}'; expected a number from {:g} to {:g}", what, text, lowest, highest));
    return value;
  }
  std::string word_or_none() {
    std::string text;
    words_ >> text;
    return text;
  }
  std::string rest() {
    std::string text;
    std::getline(words_ >> std::ws, text);
    return text.substr(0, text.find_last_not_of(" \t\r") + 1);
  }
  void end() {
    if (std::string text; words_ >> text) throw std::runtime_error(fmt::format("'{}' is too much", text));
  }

 private:
  std::istringstream words_;
};

void read_setting(LineReader& line, ViewStep& step) {
  constexpr float kUntouched = -1;  // no setting goes there
  LiveSettings settings;
#define PALPATE_FIELD(name, lowest, highest, key, meaning) settings.name = kUntouched;
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  if (const std::string wrong = apply_settings(line.word("the setting"), settings); !wrong.empty())
    throw std::runtime_error(wrong);
#define PALPATE_FIELD(name, lowest, highest, key, meaning) \
  if (settings.name != kUntouched) step.setting = &LiveSettings::name, step.value = double{settings.name};
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
}

void read_view(LineReader& line, ViewStep& step) {
  const std::string name = line.word("the view");
  const auto view = standard_views().find(name);
  if (view == standard_views().end()) throw std::runtime_error(fmt::format("no view '{}'", name));
  step.view = view->second;
}

void read_colour(LineReader& line, ViewStep& step) {
  const std::string name = line.word("what the colours show");
  const auto colour = surface_colours().find(name);
  if (colour == surface_colours().end()) throw std::runtime_error(fmt::format("no colour '{}'", name));
  step.colour = colour->second;
}

// Which joints there are, only the run's tool knows.
void read_joint(LineReader& line, ViewStep& step) {
  step.part = line.word("the joint");
  const std::size_t equals = step.part.find('=');
  if (equals == std::string::npos || equals + 1 == step.part.size()) throw std::runtime_error("no value");
}

constexpr double kLongest_s = 600;

void read_rest(LineReader& line, ViewStep& step) {
  switch (step.kind) {
    case Kind::kDrag:
      for (double* mm : {&step.at_m.x, &step.at_m.y, &step.at_m.z}) *mm = 1e-3 * line.number("a place", -1e4, 1e4);
      step.seconds = line.number("the time", 0, kLongest_s);
      return;
    case Kind::kWait:
      step.seconds = line.number("the time", 0, kLongest_s);
      return;
    case Kind::kClose:
    case Kind::kOpen:
      step.seconds = line.number("the time", 0, kLongest_s);
      step.part = line.word_or_none();
      return;
    case Kind::kJoint:
      return read_joint(line, step);
    case Kind::kFree:
      step.part = line.word("the joint");
      return;
    case Kind::kSwitch:
    case Kind::kRefused:
      step.words = line.word("the scene");
      if (const std::string more = line.rest(); !more.empty()) step.words += " " + more;
      return;
    case Kind::kScrub:
      step.value = line.number("the time", -1e6, 1e6);
      return;
    case Kind::kTurn:
      step.value = line.number("the angle to the right", -360, 360);
      step.up = line.number("the angle up", -180, 180);
      return;
    case Kind::kZoom:
      step.value = line.number("the steps", -50, 50);
      return;
    case Kind::kSet:
      return read_setting(line, step);
    case Kind::kLook:
      return read_view(line, step);
    case Kind::kColour:
      return read_colour(line, step);
    case Kind::kPicture:
      step.file = line.word("the file");
      if (!step.file.ends_with(".png")) throw std::runtime_error(step.file + ": the name must end in .png");
      return;
    case Kind::kList:
    case Kind::kRelease:
    case Kind::kFit:
    case Kind::kFollow:
      return;
  }
}

ViewStep read_step(const std::string& text) {
  LineReader line(text);
  const std::string name = line.word("a step");
  for (const Word& word : kWords) {
    if (name != word.name) continue;
    ViewStep step;
    step.kind = word.kind;
    try {
      read_rest(line, step);
      line.end();
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}; expected: {} {}", error.what(), word.name, word.rest));
    }
    return step;
  }
  throw std::runtime_error(fmt::format("no step '{}'; there are\n{}", name, view_script_words()));
}

}  // namespace

std::string view_script_words() {
  std::string text;
  for (const Word& word : kWords) text += fmt::format("  {} {}\n", word.name, word.rest);
  return text;
}

std::vector<ViewStep> parse_view_script(std::string_view text, const std::string& name) {
  std::vector<ViewStep> steps;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      steps.push_back(read_step(line));
      steps.back().where = fmt::format("{}:{}", name, number);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", name, number, error.what()));
    }
  }
  if (steps.empty()) throw std::runtime_error(name + ": no steps; there are\n" + view_script_words());
  return steps;
}

std::vector<ViewStep> read_view_script(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot open");
  return parse_view_script(std::string(std::istreambuf_iterator<char>(file), {}), path);
}

}  // namespace palpate
