// 100,000 ticks of every scene with the guard armed: no heap, no lock, no page fault, no system call. And each detector
// is shown to fire, so that silence means something.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "rt_core/record.h"
#include "rt_core/tick.h"
#include "rt_core/tool/two_tools.h"
#include "sim_host/tick_memory.h"
#include "tests/rt_guard/guard.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

constexpr int kTicks = 100000;
constexpr const char* kScenes[] = {"ellipsoid_mallet", "heart_compass",   "tools_on_cylinder",
                                   "snap_in",          "snap_in_paper",   "pinch_block_nodal",
                                   "grasp_cylinder_5", "hollow_cylinder", "ring_two_tools"};

std::string image_path(const std::string& scene) {
  if (scene == "ring_two_tools") return PALPATE_TWO_TOOLS_IMAGE;
  return std::string(PALPATE_IMAGE_DIR) + "/" + scene + ".pal";
}

// All the memory of a controller, allocated and touched before the first tick.
struct Bench {
  explicit Bench(const std::string& scene) : image(image_path(scene)) {
    reset(*state);
    mlockall(MCL_CURRENT | MCL_FUTURE);  // as the controller does; where it is refused the warm-up alone must do
  }
  // Plays the script over and over, each time from a reset state. Returns the number of ticks in which every tool is in
  // contact.
  int play(int ticks) {
    int in_contact = 0;
    ScriptedHand hand = fresh, second = fresh;
    for (int i = 0; i < ticks; ++i) {
      if (i % kScriptTicks == 0) {
        reset(*state);
        hand = second = fresh;
        *output = {};
      }
      Input input = hand.next(*output);
      if (two_tools) input.second_w = beside(second.next(as_first(*output)).pose_w);
      tick(image.model(), *state, *scratch, input, *output);
      fill_record(*state, input, *output, *record);
      const bool second_touches = !two_tools || squared_norm(output->second_w.force_N) > 0;
      in_contact += output->contacts > 0 && second_touches ? 1 : 0;
    }
    return in_contact;
  }
  // The second hand does what the first one does, a finger's width away, and feels what its own device is sent.
  static Pose beside(Pose pose_w) {
    pose_w.position_m.x -= 0.016;
    return pose_w;
  }
  static Output as_first(Output last) {
    last.device_w = last.second_w;
    return last;
  }
  ImageFile image;
  bool two_tools = has_two_tools(image.model());
  ScriptedHand fresh{image.model()};
  StatePtr state = make_state(image.model());
  ScratchPtr scratch = make_scratch(image.model());
  std::unique_ptr<Output> output = std::make_unique<Output>();
  std::unique_ptr<TickRecord> record = std::make_unique<TickRecord>();
};

class EveryScene : public testing::TestWithParam<const char*> {};

TEST_P(EveryScene, TicksWithoutHeapLockOrPageFault) {
  Bench bench(GetParam());
  bench.play(kScriptTicks);  // code pages and stack are touched as a controller's prefault does
  const long faults_before = page_faults();
  arm();
  const int in_contact = bench.play(kTicks);
  const CallCount count = disarm();
  const long faults = page_faults() - faults_before;
  EXPECT_EQ(count.total(), 0) << "first: " << count.first;
  EXPECT_EQ(faults, 0);
  EXPECT_GT(in_contact, kTicks / 2) << "the script must touch the body most of the time to prove anything";
}

// Every method of contact and every kind of tool is among them: a method that none of these scenes has is unguarded.
TEST(GuardedScenes, HaveEveryMethodAndEveryKindOfTool) {
  unsigned methods = 0, tools = 0;
  for (const char* scene : kScenes) {
    const ImageFile image(image_path(scene));
    methods |= bit_of(method_of(image.model().params));
    tools |= 1u << static_cast<unsigned>(image.model().params.articulation);
  }
  unsigned all = 0;
#define PALPATE_METHOD(name, word) all |= bit_of(Method::name);
  PALPATE_METHODS(PALPATE_METHOD)
#undef PALPATE_METHOD
  EXPECT_EQ(methods, all);
  EXPECT_EQ(tools, (1u << ChoiceOf<Articulation>::kCount) - 1);
}

TEST_P(EveryScene, TicksWithoutSystemCall) {
  Bench bench(GetParam());
  const int call = first_system_call([&bench] { bench.play(kTicks); });
  EXPECT_EQ(call, -1) << "first system call, by number (see ausyscall or asm/unistd_64.h)";
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(kScenes),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(Guard, CountsHeapUse) {
  arm();
  delete new volatile int(1);
  EXPECT_EQ(disarm().heap, 2);
  arm();
  void* volatile p = std::calloc(3, 5);
  p = std::realloc(p, 100);
  std::free(p);
  EXPECT_EQ(disarm().heap, 3);
  arm();
  void* q = nullptr;
  ASSERT_EQ(posix_memalign(&q, 64, 64), 0);
  std::free(q);
  const CallCount count = disarm();
  EXPECT_EQ(count.heap, 2);
  EXPECT_STREQ(count.first, "posix_memalign");
}

TEST(Guard, CountsLocks) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  arm();
  pthread_mutex_lock(&mutex);
  const CallCount count = disarm();
  pthread_mutex_unlock(&mutex);
  EXPECT_EQ(count.lock, 1);
  EXPECT_STREQ(count.first, "pthread_mutex_lock");
}

TEST(Guard, CountsFileAndTimeCalls) {
  arm();
  const int file = open("/dev/null", O_WRONLY);
  const CallCount opened = disarm();
  ASSERT_GE(file, 0);
  EXPECT_EQ(opened.system, 1);
  arm();
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  ASSERT_EQ(write(file, "x", 1), 1);
  close(file);
  EXPECT_EQ(disarm().system, 3);
}

TEST(Guard, IsPerThreadAndSilentWhenDisarmed) {
  arm();
  EXPECT_EQ(disarm().total(), 0);
  delete new volatile int(1);
  arm();
  EXPECT_EQ(disarm().total(), 0);
}

TEST(Guard, SeesPageFaults) {
  constexpr std::size_t kPages = 16, kPage = 4096;
  void* memory = mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  madvise(memory, kPages * kPage, MADV_NOHUGEPAGE);
  const long before = page_faults();
  for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(memory)[i * kPage] = 1;
  EXPECT_GE(page_faults() - before, static_cast<long>(kPages));
  munmap(memory, kPages * kPage);
}

TEST(Guard, NamesTheSystemCall) {
  EXPECT_EQ(first_system_call([] { getppid(); }), SYS_getppid);
  EXPECT_EQ(first_system_call([] { [[maybe_unused]] const auto n = write(1, "", 0); }), SYS_write);
  EXPECT_EQ(first_system_call([] {}), -1);
  EXPECT_EQ(first_system_call([] { std::abort(); }), SYS_rt_sigprocmask);
}

}  // namespace
}  // namespace palpate::test
