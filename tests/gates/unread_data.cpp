// Unread-data gate: an array of an image that no tick of its scene reads, or a parameter that no tick of any scene
// reads, is an error unless a reader outside the tick is declared (sim_host/bake/data_readers.h) and exists.
//
// Measured, not argued: every array is copied to pages of its own that may not be read; the first read raises a fault,
// whose handler notes the array and opens its pages. The parameters lie together on one page, which is closed again
// after each read by single-stepping over the instruction; its width comes from its bytes. x86-64 only, as is the whole
// build. Proves itself by a planted array and a planted parameter that nobody reads.
// Usage: unread_data ROOT IMAGE...
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <memory>
#include <new>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "rt_core/tick.h"
#include "sim_host/bake/data_readers.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

const std::size_t kPage = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));

struct Watched {
  const char* name;
  char* data;
  std::size_t bytes;  // whole pages
  volatile bool read;
};

// What the handlers need; filled before the first protected access.
Watched watched_array[64];
volatile int watched_arrays = 0;
char* parameter_page = nullptr;
constexpr std::size_t kMostParameterBytes = 4096;
volatile unsigned char parameter_read[kMostParameterBytes];
volatile long parameter_faults = 0;

// Bytes that the instruction reads, at most: a scalar of 4 or 8, or a vector.
std::size_t width_of(const unsigned char* code) {
  bool operand16 = false;
  for (; *code == 0x66 || *code == 0xF2 || *code == 0xF3; ++code) operand16 = operand16 || *code == 0x66;
  if (*code != 0xC4 && *code != 0xC5) return (*code & 0xF8) == 0x48 || operand16 ? 8 : 4;
  const bool long_form = *code == 0xC4;
  const unsigned prefix = code[long_form ? 2 : 1], map = long_form ? code[1] & 0x1Fu : 1u;
  const unsigned opcode = code[long_form ? 3 : 2], kind = prefix & 3u;
  if (map == 1 && (opcode == 0x2E || opcode == 0x2F)) return kind == 1 ? 8 : 4;  // compare of scalars
  if (map == 1 && (opcode == 0x12 || opcode == 0x16 || opcode == 0x6E)) return 8;
  if (map == 2 && (opcode == 0x18 || opcode == 0x19)) return opcode == 0x18 ? 4 : 8;  // broadcast
  if (kind >= 2) return 8;
  return (prefix & 4u) != 0 ? 32 : 16;
}

void on_fault(int, siginfo_t* info, void* context) {
  char* const at = static_cast<char*>(info->si_addr);
  auto* registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  if (parameter_page != nullptr && at >= parameter_page && at < parameter_page + kPage) {
    const auto* code = reinterpret_cast<const unsigned char*>(registers[REG_RIP]);
    const auto first = static_cast<std::size_t>(at - parameter_page);
    const std::size_t width = width_of(code);
    for (std::size_t i = first; i < first + width && i < kPage; ++i) parameter_read[i] = 1;
    parameter_faults = parameter_faults + 1;
    mprotect(parameter_page, kPage, PROT_READ | PROT_WRITE);
    registers[REG_EFL] |= 0x100;  // trap after this instruction
    return;
  }
  for (int i = 0; i < watched_arrays; ++i) {
    Watched& w = watched_array[i];
    if (at < w.data || at >= w.data + w.bytes) continue;
    w.read = true;
    mprotect(w.data, w.bytes, PROT_READ);
    return;
  }
  std::signal(SIGSEGV, SIG_DFL);  // a fault of somebody's own
}

// A tick may read a parameter in a loop over contacts: beyond so many reads in one tick the rest goes unwatched.
constexpr long kMostFaultsPerTick = 2000;

void on_step(int, siginfo_t*, void* context) {
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_EFL] &= ~0x100ll;
  if (parameter_faults < kMostFaultsPerTick) mprotect(parameter_page, kPage, PROT_NONE);
}

void install() {
  struct sigaction action {};
  action.sa_flags = SA_SIGINFO;
  action.sa_sigaction = on_fault;
  sigaction(SIGSEGV, &action, nullptr);
  action.sa_sigaction = on_step;
  sigaction(SIGTRAP, &action, nullptr);
}

char* pages(std::size_t bytes) {
  void* data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) throw std::runtime_error("mmap");
  return static_cast<char*>(data);
}

template <class T>
std::span<const T> watch(const char* name, std::span<const T> array) {
  if (array.empty()) return array;
  if (watched_arrays == static_cast<int>(std::size(watched_array))) throw std::runtime_error("too many arrays");
  const std::size_t bytes = (array.size_bytes() + kPage - 1) / kPage * kPage;
  char* data = pages(bytes);
  std::memcpy(data, array.data(), array.size_bytes());
  mprotect(data, bytes, PROT_NONE);
  watched_array[watched_arrays] = {name, data, bytes, false};
  watched_arrays = watched_arrays + 1;
  return {reinterpret_cast<const T*>(data), array.size()};
}

// A copy of the model whose arrays are watched and whose parameters end where a page does.
class WatchedModel {
 public:
  explicit WatchedModel(const Model& model) : block_(pages(3 * kPage)) {
    watched_arrays = 0;
    static_assert(offsetof(Model, params) == 0 && sizeof(ModelParams) + 8 <= kMostParameterBytes);
    model_ = new (block_ + kPage - sizeof(ModelParams)) Model(model);
#define PALPATE_WATCH(type, name, count, frame, meaning) model_->name = watch(#name, model.name);
    PALPATE_MODEL_ARRAYS(PALPATE_WATCH)
#undef PALPATE_WATCH
    const double nobody_reads[1] = {1};
    watch<double>("planted", nobody_reads);
    parameter_page = block_;
  }
  ~WatchedModel() {
    parameter_page = nullptr;
    for (int i = 0; i < watched_arrays; ++i) munmap(watched_array[i].data, watched_array[i].bytes);
    munmap(block_, 3 * kPage);
  }
  WatchedModel(const WatchedModel&) = delete;
  WatchedModel& operator=(const WatchedModel&) = delete;
  const Model& model() const { return *model_; }
  void tick_with_closed_parameters(State& state, Scratch& scratch, const Input& input, Output& output) {
    parameter_faults = 0;
    mprotect(block_, kPage, PROT_NONE);
    tick(*model_, state, scratch, input, output);
    mprotect(block_, kPage, PROT_READ | PROT_WRITE);
  }
  static bool has_read(std::size_t offset, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
      if (parameter_read[kPage - sizeof(ModelParams) + offset + i] != 0) return true;
    return false;
  }

 private:
  char* block_;
  Model* model_;
};

// What rings at a touch is read about at the touch and after it alone.
bool may_begin_to_ring(const Model& model, const State& state, const Output& last) {
  if (!(model.params.transient_N_per_m_s > 0)) return false;
  return last.regions == 0 || state.safety.ring_ticks == model.params.transient_ticks;
}

// The scripted hand, its first ticks and every 400th with closed parameters; then what goes wrong with a device: a
// jump, silence to the fault, a reset, a stop.
void play(WatchedModel& watched) {
  const Model& model = watched.model();
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  Input input;
  ScriptedHand hand(model);
  for (int i = 0; i < kScriptTicks; ++i) {
    input = hand.next(output);
    if (i < 3 || i % 400 == 399 || may_begin_to_ring(model, *state, output))
      watched.tick_with_closed_parameters(*state, *scratch, input, output);
    else
      tick(model, *state, *scratch, input, output);
  }
  input.pose_w.position_m.x += 1;
  watched.tick_with_closed_parameters(*state, *scratch, input, output);
  input.pose_w.position_m.x -= 1;
  for (std::uint32_t late = 1; late <= 60; ++late) {
    input.stale_ticks = late;
    if (late % 3 == 0)
      watched.tick_with_closed_parameters(*state, *scratch, input, output);
    else
      tick(model, *state, *scratch, input, output);
  }
  input.stale_ticks = 0;
  for (const std::uint32_t command : {Command::kReset, 0u, Command::kArm, Command::kStop, Command::kStop}) {
    input.commands = command;
    watched.tick_with_closed_parameters(*state, *scratch, input, output);
  }
}

const char* declared_reader(const char* name) {
  for (const DataReader& r : kDataReaders)
    if (std::strcmp(r.name, name) == 0) return r.reader;
  return nullptr;
}

// A declared reader is a file that names what it reads.
int check_readers(const std::string& root) {
  int wrong = 0;
  for (const DataReader& r : kDataReaders) {
    std::ifstream file(root + "/" + r.reader);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (text.find(std::string(".") + r.name) != std::string::npos) continue;
    std::printf("%s: declared to be read by %s, which does not name it\n", r.name, r.reader);
    wrong += 1;
  }
  return wrong;
}

int run(const std::string& root, std::span<char*> images) {
  install();
  int wrong = check_readers(root), planted = 0;
  for (char* path : images) {
    const ImageFile image(path);
    WatchedModel watched(image.model());
    play(watched);
    for (int i = 0; i < watched_arrays; ++i) {
      const Watched& w = watched_array[i];
      if (std::strcmp(w.name, "planted") == 0)
        planted += w.read ? 0 : 1;
      else if (!w.read && declared_reader(w.name) == nullptr) {
        std::printf("%s: no tick reads the array %s: do not bake it here, or declare who reads it\n",
                    image.model().name, w.name);
        wrong += 1;
      }
    }
  }
#define PALPATE_CHECK(type, name, unit, lowest, highest, meaning)                                                \
  if (!WatchedModel::has_read(offsetof(ModelParams, name), sizeof(type)) && declared_reader(#name) == nullptr) { \
    std::printf("no tick of any scene reads the parameter %s: remove it, or declare who reads it\n", #name);     \
    wrong += 1;                                                                                                  \
  }
  PALPATE_MODEL_PARAMS(PALPATE_CHECK)
#undef PALPATE_CHECK
  // The gate must fire: an array of each scene, and the 8 bytes before the parameters, which nobody reads.
  bool before = false;
  for (std::size_t i = 0; i < 8; ++i) before = before || parameter_read[kPage - sizeof(ModelParams) - 8 + i] != 0;
  if (planted != static_cast<int>(images.size()) || before ||
      !WatchedModel::has_read(offsetof(ModelParams, period_s), 8)) {
    std::printf("the gate does not tell read from unread\n");
    return 2;
  }
  std::printf("unread data: %zu scenes, %d problems; the planted array was noticed in each\n", images.size(), wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: unread_data ROOT IMAGE...\n");
    return 2;
  }
  try {
    return palpate::test::run(argv[1], std::span<char*>(argv + 2, static_cast<std::size_t>(argc - 2)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "unread_data: %s\n", error.what());
    return 2;
  }
}
