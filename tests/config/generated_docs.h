// Documents whose last section is generated from tables in the code: checks that it is current.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace palpate {

// Expects everything after the line `heading` of `path` to be `generated`. Run with PALPATE_WRITE_DOCS=1 in the
// environment to rewrite it instead.
inline void expect_generated(const std::string& path, const std::string& heading, const std::string& generated) {
  std::ifstream stream(path);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t at = text.find(heading + "\n");
  ASSERT_NE(at, std::string::npos) << path << " has no line '" << heading << "'";
  const std::size_t body = at + heading.size() + 1;
  if (std::getenv("PALPATE_WRITE_DOCS") != nullptr) {
    std::ofstream(path) << text.substr(0, body) << generated;
    return;
  }
  EXPECT_EQ(text.substr(body), generated) << path << " is out of date: run the test with PALPATE_WRITE_DOCS=1";
}

}  // namespace palpate
