#include "config/scene/progress.h"

#include <memory>

namespace palpate {

Progress progress_bar(std::FILE* out) {
  struct Last {
    std::string what;
    int percent = -1;
  };
  return [out, last = std::make_shared<Last>()](const char* what, double fraction) {
    constexpr int kWidth = 40;
    const int percent = fraction >= 1 ? 100 : fraction > 0 ? static_cast<int>(100 * fraction) : 0;
    if (last->what == what && last->percent == percent) return;
    *last = {what, percent};
    const int filled = percent * kWidth / 100;
    std::fprintf(out, "\r%-28s [%s%s] %3d %%", what, std::string(static_cast<std::size_t>(filled), '=').c_str(),
                 std::string(static_cast<std::size_t>(kWidth - filled), ' ').c_str(), percent);
    if (percent == 100) std::fputc('\n', out);
    std::fflush(out);
  };
}

}  // namespace palpate
