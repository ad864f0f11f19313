#include "hal/drives/cia402_sim.h"

#include <iterator>

namespace palpate {

using namespace canopen;

namespace {

// Abort codes (CiA 301, table 22).
constexpr std::uint32_t kReadOnly = 0x06010002, kWrongLength = 0x06070010, kNotNow = 0x08000022, kGeneral = 0x08000000;

// The bytes of an SDO download by its specifier.
int length_of(std::uint8_t specifier) noexcept { return 4 - (specifier >> 2 & 3); }

}  // namespace

Cia402Sim::Cia402Sim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path)
    : transport_(transport), arm_(arm), plant_(arm, plant, std::move(path)) {
  for (int i = 0; i < plant_.count(); ++i) make_dictionary(i);
}

void Cia402Sim::make_dictionary(int axis) {
  Drive& d = drive_[axis];
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  d.node = static_cast<int>(a.node);
  const auto word = [](double value) { return static_cast<std::uint32_t>(value + 0.5); };
  const auto put = [&](std::uint32_t object, int bytes, std::uint32_t value, bool writable) {
    d.object[object] = {bytes, value, writable, false, false};
  };
  put(kDeviceType, 4, 0x00020192, false);
  put(kConsumerHeartbeat, 4, 0, true);
  put(kVendor, 4, word(arm_.drives.vendor_id), false);
  put(kProduct, 4, word(arm_.drives.product_code), false);
  put(kRevision, 4, word(arm_.drives.revision), false);
  put(kSerial, 4, word(a.serial), false);
  for (const std::uint32_t cob : {kRpdoCob, kTpdoCob}) {
    put(cob, 4, kPdoOff, true);
    put(cob + 1, 1, 0xFF, true);  // event-driven, as drives come
  }
  for (const std::uint32_t count : {kRpdoCount, kTpdoCount}) {
    put(count, 1, 1, true);
    put(count + 1, 4, mapped(count == kRpdoCount ? kControlword : kStatusword, 16), true);
    put(count + 2, 4, 0, true);
  }
  put(kAbortOption, 2, 0, true);
  put(kMode, 1, 0, true);
  put(kModeDisplay, 1, 0, false);
  put(kMaxTorque, 2, 1000, true);
  put(kRatedTorque, 4, word(1e3 * a.rated_Nm), false);
  put(kPolarity, 1, 0, true);
  put(kEncoderIncrements, 4, word(a.counts_per_turn), false);
  put(kEncoderTurns, 4, 1, false);
  put(kPosition, 4, 0, false);
  put(kProbeFunction, 2, 0, true);
  put(kProbeStatus, 2, 0, false);
  put(kProbePosition, 4, 0, false);
  put(kPeriodValue, 1, 1, true);
  put(kPeriodExponent, 1, 0xFD, true);
  put(kSupportedModes, 4, kTorqueModeBit | 1u << 7, false);
}

std::uint32_t Cia402Sim::get(int axis, std::uint32_t object) const noexcept {
  const auto found = drive_[axis].object.find(object);
  return found != drive_[axis].object.end() ? found->second.value : 0;
}
std::uint32_t Cia402Sim::object(int axis, std::uint32_t object) const noexcept { return get(axis, object); }

// 0, or the abort code.
std::uint32_t Cia402Sim::store(int axis, std::uint32_t object, std::uint32_t value) noexcept {
  Drive& d = drive_[axis];
  const bool mapping = object >> 8 == kRpdoCount >> 8 || object >> 8 == kTpdoCount >> 8;
  const std::uint32_t cob = object >> 8 == kRpdoCount >> 8 ? kRpdoCob : kTpdoCob;
  const std::uint32_t count = object >> 8 << 8;
  // A mapping changes before operation, while its PDO is off; its entries while none counts.
  if (mapping && (d.network != kIsPreOperational || (get(axis, cob) & kPdoOff) == 0)) return kNotNow;
  if (mapping && object != count && get(axis, count) != 0) return kNotNow;
  if (!d.object[object].frozen) d.object[object].value = value;
  if (object == kMode && !d.object[kModeDisplay].frozen) d.object[kModeDisplay].value = value;
  if (object == kProbeFunction) {
    d.object[kProbeStatus].value = value & 1;
    d.sought = 0;
  }
  return 0;
}

void Cia402Sim::take_sdo(int axis, const Frame& frame) noexcept {
  Drive& d = drive_[axis];
  const std::uint32_t object = sdo_object(frame), id = kSdoReply + static_cast<std::uint32_t>(d.node);
  const auto found = d.object.find(object);
  if (object == kPosition && found != d.object.end())
    found->second.value = static_cast<std::uint32_t>(static_cast<std::int32_t>(counts(axis)));
  std::uint32_t abort = found == d.object.end() ? kNoObject : found->second.hidden ? kGeneral : 0;
  Frame reply;
  if (abort == 0 && frame.data[0] == kUpload) {
    reply = sdo_frame(id, uploaded_of(found->second.bytes), object, found->second.value);
  } else if (abort == 0) {
    const int bytes = length_of(frame.data[0]);
    auto value = get_bytes<std::uint32_t>(frame, 4);
    if (bytes < 4) value &= (1u << 8 * bytes) - 1;
    if (!found->second.writable) abort = kReadOnly;
    if (bytes != found->second.bytes) abort = kWrongLength;
    if (abort == 0) abort = store(axis, object, value);
    reply = sdo_frame(id, kDownloaded, object, 0);
  }
  if (abort != 0) reply = sdo_frame(id, kAborted, object, abort);
  send_frames(transport_, &reply, 1);
}

void Cia402Sim::send_emergency(int axis, std::uint16_t code) noexcept {
  Frame frame = classic_frame(kEmergency + static_cast<std::uint32_t>(drive_[axis].node), 8);
  put_bytes(frame, 0, code);
  // The error register: generic, and the bit of the code's class.
  constexpr std::uint8_t kOfClass[] = {0, 0, 0x02, 0x04, 0x08, 0x20, 0x20, 0x20, 0x10};
  const unsigned kind = code >> 12;
  frame.data[2] =
      code == 0 ? 0 : static_cast<std::uint8_t>(0x01 | (kind < std::size(kOfClass) ? kOfClass[kind] : 0x80));
  send_frames(transport_, &frame, 1);
}

void Cia402Sim::enter_fault(int axis, std::uint16_t emergency) noexcept {
  drive_[axis].state = DriveState::kFault;
  send_emergency(axis, emergency);
}

void Cia402Sim::restart(int axis) noexcept {
  Drive& d = drive_[axis];
  make_dictionary(axis);
  d.network = kIsPreOperational;
  d.state = DriveState::kDisabled;
  d.beating = false;
  Frame frame = classic_frame(kHeartbeat + static_cast<std::uint32_t>(d.node), 1);
  send_frames(transport_, &frame, 1);
}

// The next state the controlword asks for; one step a SYNC.
void Cia402Sim::obey(int axis) noexcept {
  Drive& d = drive_[axis];
  const std::uint32_t c = d.control;
  const bool reset = (c & kFaultReset) != 0 && (d.last_control & kFaultReset) == 0;
  d.last_control = c;
  if (d.state == DriveState::kFault) {
    if (!reset) return;
    d.state = DriveState::kDisabled;
    return send_emergency(axis, 0);
  }
  if ((c & 0x02) == 0) {
    d.state = DriveState::kDisabled;
  } else if ((c & 0x87) == 0x06) {
    d.state = DriveState::kReady;
  } else if ((c & 0x8F) == 0x07 && d.state == DriveState::kReady && !d.stuck) {
    d.state = DriveState::kSwitchedOn;
  } else if ((c & 0x8F) == 0x0F && d.state == DriveState::kSwitchedOn) {
    d.state = DriveState::kEnabled;
  }
}

std::uint32_t Cia402Sim::statusword(int axis) const noexcept {
  constexpr std::uint32_t kRemote = 0x0200;
  switch (drive_[axis].state) {
    case DriveState::kReady:
      return kRemote | 0x31;
    case DriveState::kSwitchedOn:
      return kRemote | 0x33;
    case DriveState::kEnabled:
      return kRemote | 0x37;
    case DriveState::kFault:
      return kRemote | 0x08;
    default:
      return kRemote | 0x40;
  }
}

// Of an encoder with index: what it counts at the mark that home_turns counts from; it was switched on anywhere.
std::int32_t Cia402Sim::mark(int axis) const noexcept { return arm_.index ? -123456 * (axis + 1) : 0; }

// Until its mark was passed the handle is about where it lay when the drives were switched on: in its home pose.
double Cia402Sim::counts(int axis) noexcept {
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  const bool waits = arm_.index && (get(axis, kProbeStatus) & kCaught) == 0;
  const double turns = waits ? a.home_turns + drive_[axis].beside_turns : plant_.turns(axis);
  return turns * a.counts_per_turn + mark(axis);
}

// The hand brings the encoders past a mark, one after another; not always past the same one of those at every turn.
void Cia402Sim::probe(int axis) noexcept {
  Drive& d = drive_[axis];
  if (get(axis, kProbeFunction) != kCatchIndex || d.stays || ++d.sought != 10 * (axis + 1)) return;
  const double counts_per_turn = arm_.axes[static_cast<std::size_t>(axis)].counts_per_turn;
  const int turn = axis % 3 - 1;
  d.object[kProbePosition].value =
      static_cast<std::uint32_t>(mark(axis) + turn * static_cast<std::int32_t>(counts_per_turn));
  d.object[kProbeStatus].value |= kCaught;
}

// The TPDO as it was mapped.
void Cia402Sim::send_position(int axis) noexcept {
  const Drive& d = drive_[axis];
  const std::uint32_t cob = get(axis, kTpdoCob);
  if ((cob & kPdoOff) != 0 || get(axis, kTpdoType) != 1) return;
  Frame frame = classic_frame(cob & 0x7FF, 0);
  for (std::uint32_t i = 1; i <= get(axis, kTpdoCount); ++i) {
    const std::uint32_t entry = get(axis, kTpdoCount + i);
    if (entry == mapped(kStatusword, 16)) put_bytes(frame, frame.length, static_cast<std::uint16_t>(statusword(axis)));
    if (entry == mapped(kPosition, 32)) put_bytes(frame, frame.length, static_cast<std::int32_t>(counts(axis)));
    frame.length = static_cast<std::uint8_t>(frame.length + (entry & 0xFF) / 8);
  }
  if (!d.mute) send_frames(transport_, &frame, 1);
}

void Cia402Sim::synchronise(int axis) noexcept {
  Drive& d = drive_[axis];
  if (d.network != kOperational) return;
  if (d.has_pending) {
    int at = 0;
    for (std::uint32_t i = 1; i <= get(axis, kRpdoCount); ++i) {
      const std::uint32_t entry = get(axis, kRpdoCount + i);
      if (entry == mapped(kControlword, 16)) d.control = get_bytes<std::uint16_t>(d.pending, at);
      if (entry == mapped(kTargetTorque, 16)) d.torque = get_bytes<std::int16_t>(d.pending, at);
      at += static_cast<int>((entry & 0xFF) / 8);
    }
  }
  d.has_pending = false;
  obey(axis);
  send_position(axis);
}

void Cia402Sim::take(const Frame& frame) noexcept {
  for (int i = 0; i < plant_.count(); ++i) {
    Drive& d = drive_[i];
    const auto node = static_cast<std::uint32_t>(d.node);
    if (frame.fd || d.mute) continue;
    if (frame.id == kNmt && (frame.data[1] == 0 || frame.data[1] == node))
      d.network = frame.data[0] == kStart ? kOperational : kIsPreOperational;
    if (frame.id == kSdoRequest + node) take_sdo(i, frame);
    if (frame.id == kHeartbeat + kMasterNode) {
      d.beating = true;
      d.beat_s = 0;
    }
    if (frame.id == (get(i, kRpdoCob) & ~kNoRemote)) {  // with bit 31, off, it equals no identifier
      d.pending = frame;
      d.has_pending = true;
    }
    if (frame.id == kSync && frame.length == 0) synchronise(i);
  }
}

// The controller's heartbeat, watched from the first one on.
void Cia402Sim::watch(int axis) noexcept {
  Drive& d = drive_[axis];
  d.beat_s += plant_.plant().options().period_s;
  const std::uint32_t consumer = get(axis, kConsumerHeartbeat);
  const double most_s = 1e-3 * (consumer & 0xFFFF);
  const bool watched = d.beating && most_s > 0 && consumer >> 16 == kMasterNode;
  if (!watched || d.beat_s <= most_s || d.network != kOperational) return;
  d.beating = false;
  heartbeats_lost_ += 1;
  if (get(axis, kAbortOption) != 0) enter_fault(axis, kHeartbeatLost);
}

void Cia402Sim::step_bus() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
  for (int i = 0; i < plant_.count(); ++i) {
    watch(i);
    probe(i);
  }
}

void Cia402Sim::step() noexcept {
  step_bus();
  double torque_Nm[kMaxAxes];
  bool on[kMaxAxes];
  for (int i = 0; i < plant_.count(); ++i) {
    const double most = get(i, kMaxTorque);
    on[i] = enabled(i) && get(i, kMode) == kTorqueMode;
    torque_Nm[i] = 1e-3 * clamp_to(drive_[i].torque, -most, most) * (1e-3 * get(i, kRatedTorque));
  }
  plant_.step(torque_Nm, on);
}

}  // namespace palpate
