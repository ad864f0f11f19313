#include "hal/drives/moved_record.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

namespace palpate {
namespace {

std::string record_of(const std::string& profile) { return profile + ".moved"; }

std::optional<std::string> text_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

std::string record_moved(const std::string& profile) {
  std::error_code error;
  std::filesystem::copy_file(profile, record_of(profile), std::filesystem::copy_options::overwrite_existing, error);
  return error ? record_of(profile) + ": " + error.message() : "";
}

bool is_moved(const std::string& profile) {
  const std::optional<std::string> now = text_of(profile);
  return now && now == text_of(record_of(profile));
}

std::string text_if_unmoved(const std::string& device, const std::string& profile) {
  if (is_moved(profile)) return "";
  return "signs and axes were not checked with this profile: palpate device-test " + device + " --profile " + profile +
         " --move";
}

}  // namespace palpate
