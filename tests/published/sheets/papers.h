// One sheet a paper. `folder`: where figures.sh left its tables, with a slash at its end.
#pragma once

#include <string>

#include "tests/published/sheets/sheet.h"

namespace palpate::papers {

Sheet luo_xiao_2006(const std::string& folder);
Sheet circular_beams_2009(const std::string& folder);
Sheet mahvash_hayward_2002(const std::string& folder);
Sheet duriez_2003(const std::string& folder);
Sheet cui_xiao_2008(const std::string& folder);

}  // namespace palpate::papers
