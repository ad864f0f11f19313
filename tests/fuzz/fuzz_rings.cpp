// Both shared memories as the other side may leave them: the controller reads any mailbox without harm and believes
// only valid commands; the host reads any telemetry region without harm, and neither waits for ever.
#include <cstdlib>
#include <memory>

#include "sim_host/rings/mailbox.h"
#include "sim_host/rings/telemetry.h"
#include "tests/fuzz/edits.h"

using namespace palpate;

namespace {

void read_mailbox(const std::uint8_t* data, std::size_t size) {
  MailboxRegion region{};
  MailboxWriter writer(region);
  writer.set(Command::kArm, false);
  writer.beat();
  std::span<std::byte> bytes(reinterpret_cast<std::byte*>(&region), sizeof(region));
  MailboxReader reader(region);
  HostCommand command;
  // Read after each edit, as a controller would while its host goes mad.
  for (; size >= fuzz::kEditBytes; data += fuzz::kEditBytes, size -= fuzz::kEditBytes) {
    fuzz::apply_all(data, fuzz::kEditBytes, bytes);
    check_mailbox(region);
    if (reader.poll(command) != MailboxResult::kAccepted) continue;
    if ((command.commands & ~kKnownCommands) != 0 || command.quit > 1 || !is_valid(command.joints)) abort();
  }
}

void read_telemetry(const std::uint8_t* data, std::size_t size) {
  static const auto region = std::make_unique<TelemetryRegion>();
  TelemetryWriter writer;
  Model model;
  model.name = "fuzz";
  writer.open(*region, model, 1'000'000, "build", "image");
  TickRecord record{};
  for (int i = 0; i < 8; ++i) writer.write(record);
  // The head of the region and the first slots: all of it is the same slot over again.
  const std::size_t reach = offsetof(TelemetryRegion, slot) + 12 * sizeof(TelemetryRegion::Slot);
  std::span<std::byte> bytes(reinterpret_cast<std::byte*>(region.get()), reach);
  TelemetryReader reader(*region);
  for (; size >= fuzz::kEditBytes; data += fuzz::kEditBytes, size -= fuzz::kEditBytes) {
    fuzz::apply_all(data, fuzz::kEditBytes, bytes);
    check_telemetry(*region);
    reader.newest(record);
    for (int i = 0; i < 16 && reader.next(record); ++i) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  if (data[0] % 2 == 0) read_mailbox(data + 1, size - 1);
  if (data[0] % 2 != 0) read_telemetry(data + 1, size - 1);
  return 0;
}
