// Contact sheets of the five papers' figures: drawings and pictures from the shipped scenes, plots from the tables that
// figures.sh left in its folder.
// Usage: paper_sheets FOLDER: reads FOLDER/*.csv, writes FOLDER/papers_YEAR.png
#include <cstdio>
#include <exception>

#include "tests/published/sheets/papers.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: paper_sheets FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::string folder = std::string(argv[1]) + "/";
    using namespace palpate::papers;
    luo_xiao_2006(folder).save(folder + "papers_2006.png");
    circular_beams_2009(folder).save(folder + "papers_2009.png");
    mahvash_hayward_2002(folder).save(folder + "papers_2002.png");
    duriez_2003(folder).save(folder + "papers_2003.png");
    cui_xiao_2008(folder).save(folder + "papers_2008.png");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "paper_sheets: %s\n", error.what());
    return 1;
  }
}
