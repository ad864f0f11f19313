// Linked into every test program: what its tests write to the temporary folder goes into one of the process's own,
// which is gone when it ends. Processes that a test starts inherit it and leave it alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

constexpr char kVariable[] = "TMPDIR";  // heeded by testing::TempDir(), std::filesystem and what tests start

class OwnTemporaryFolder : public testing::Environment {
 public:
  void SetUp() override {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    if (error || parent.filename().string().starts_with(kPrefix)) return;
    std::string name = (parent / (std::string(kPrefix) + "XXXXXX")).string();
    ASSERT_NE(mkdtemp(name.data()), nullptr) << name;
    ASSERT_EQ(setenv(kVariable, name.c_str(), 1), 0);
    folder_ = name;
    owner_ = getpid();
  }
  void TearDown() override {
    std::error_code error;
    if (!folder_.empty() && getpid() == owner_) std::filesystem::remove_all(folder_, error);
  }

 private:
  static constexpr char kPrefix[] = "palpate-test-";
  std::filesystem::path folder_;
  pid_t owner_ = 0;
};

[[maybe_unused]] testing::Environment* const own_folder = testing::AddGlobalTestEnvironment(new OwnTemporaryFolder);

}  // namespace
