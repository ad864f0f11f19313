#include "sim_host/doctor/doctor_json.h"

namespace palpate {

namespace {

const char* verdict_word(Verdict verdict) {
  if (verdict == Verdict::kPass) return "pass";
  return verdict == Verdict::kFail ? "fail" : "unknown";
}

}  // namespace

Json items_json(const std::vector<DoctorItem>& items) {
  Json all = Json::array();
  for (const DoctorItem& item : items)
    all.push_back(
        {{"item", item.name}, {"verdict", verdict_word(item.verdict)}, {"found", item.found}, {"remedy", item.remedy}});
  return all;
}

}  // namespace palpate
