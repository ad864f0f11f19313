// A haptic device: docs/wire_protocol.md over the loopback, with a simulated hand that presses and withdraws.
//
//   cc -O2 device.c -o device -lm
//   ./device mine & palpate device-test loopback:mine
//   ./device mine & palpate run config/scenes/ellipsoid_mallet.toml --device loopback:mine --duration 4
#define _GNU_SOURCE
#include <errno.h>
#include <linux/can.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

enum { NODE = 1, VERSION = 2, CALIBRATED = 1, ENABLED = 2, LET_GO = 16, CUT = 32 };
static const double FORCE_MAX_N = 8.5, MASS_KG = 0.2, DAMPING_NS_PER_M = 10, HAND_N_PER_M = 800;

struct device {
  int bus, heard, enabled, let_go, silent_ms, old_run;
  uint16_t echo, old;
  uint32_t ticks;
  double wanted_N[3], force_N[3], position_m[3], velocity[3], felt_N;
};

static unsigned checksum(unsigned identifier, const uint8_t* payload, int bytes) {
  unsigned crc = 0xFFFF;
  for (int i = -2; i < bytes; ++i) {
    crc ^= (i == -2 ? identifier & 0xFFu : i == -1 ? identifier >> 8 : payload[i]) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1 ^ (crc & 0x8000u ? 0x1021u : 0u)) & 0xFFFFu;
  }
  return crc;
}

static uint16_t get16(const uint8_t* from) { return (uint16_t)(from[0] | from[1] << 8); }
static uint8_t* put(uint8_t* to, int bytes, uint32_t value) {
  for (; bytes > 0; --bytes, value >>= 8) *to++ = (uint8_t)value;
  return to;
}
static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static struct device new_device(int bus) {  // zero force until enable goes from 0 to 1
  return (struct device){.bus = bus, .enabled = 1, .let_go = 1, .position_m = {-0.010, 0.090, 0}};
}

// One frame that arrived; a command that is valid and new is obeyed.
static void take(struct device* d, const struct canfd_frame* frame) {
  if (frame->can_id != 0x100 + NODE || frame->len != 20) return;
  if (get16(frame->data + 18) != checksum(frame->can_id, frame->data, 18)) return;
  const uint16_t number = get16(frame->data), flags = get16(frame->data + 4);
  // Twice, or late: dropped; but four that follow one another are of a controller that has started again.
  if (d->heard && (uint16_t)(d->echo - number) <= 0x3FFF) {
    d->old_run = number == (uint16_t)(d->old + 1) ? d->old_run + 1 : 1;
    d->old = number;
    if (d->old_run < 4) return;
  }
  d->heard = 1, d->echo = number, d->old_run = d->silent_ms = 0;
  if ((flags & 1) && !d->enabled) d->let_go = 0;
  d->enabled = flags & 1;
  for (int i = 0; i < 3; ++i) d->wanted_N[i] = (int16_t)get16(frame->data + 6 + 2 * i) * 1e-3;  // torque: no motors
}

// The hand aims 28 mm down and up again every 2 s, and pulls the handle there like a spring.
static void move(struct device* d) {
  const double aim_m[3] = {-0.010, 0.076 + 0.014 * cos(3.14159265358979 * d->ticks * 1e-3), 0};
  for (int i = 0; i < 3; ++i) {
    const double pull_N = HAND_N_PER_M * (aim_m[i] - d->position_m[i]) - DAMPING_NS_PER_M * d->velocity[i];
    d->velocity[i] += 1e-3 * (pull_N + d->force_N[i]) / MASS_KG;
    d->position_m[i] += 1e-3 * d->velocity[i];
  }
}

static void send_status(struct device* d, unsigned flags) {
  struct canfd_frame frame = {.can_id = 0x180 + NODE, .len = 32, .flags = CANFD_BRS};
  uint8_t* to = put(put(put(frame.data, 2, ++d->ticks), 2, d->echo), 2, flags);
  to = put(put(to, 2, 0), 4, d->ticks * 1000);  // buttons, error code; device time
  for (int i = 0; i < 3; ++i) to = put(to, 3, (uint32_t)lround(d->position_m[i] * 1e7));
  to = put(put(put(to, 2, 32767), 6, 0), 1, VERSION);  // the handle never turns
  put(to, 2, checksum(frame.can_id, frame.data, 30));
  send(d->bus, &frame, sizeof frame, MSG_DONTWAIT | MSG_NOSIGNAL);  // what nobody takes is dropped, never sent later
}

// One millisecond: commands, motors, hand, status. 0 when the controller has gone.
static int step(struct device* d) {
  struct canfd_frame frame;
  ssize_t bytes;
  while ((bytes = recv(d->bus, &frame, sizeof frame, MSG_DONTWAIT)) > 0)
    if (bytes == sizeof frame) take(d, &frame);
  if (bytes == 0 || errno != EAGAIN) return 0;
  if (++d->silent_ms > 20) d->enabled = d->let_go = 1;
  const int on = d->enabled && !d->let_go;
  const double cut = on ? fmin(1, FORCE_MAX_N / fmax(length(d->wanted_N), 1e-9)) : 0;
  double change[3];
  for (int i = 0; i < 3; ++i) change[i] = cut * d->wanted_N[i] - d->force_N[i];
  const double share = fmin(1, 0.1 * FORCE_MAX_N / fmax(length(change), 1e-9));  // a slope, not a step
  for (int i = 0; i < 3; ++i) d->force_N[i] += share * change[i];
  d->felt_N = fmax(d->felt_N, length(d->force_N));
  move(d);
  send_status(d, CALIBRATED | (on ? ENABLED : 0u) | (d->let_go ? LET_GO : 0u) | (on && cut < 1 ? CUT : 0u));
  return 1;
}

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "palpate";
  struct sockaddr_un address = {.sun_family = AF_UNIX};  // an abstract name begins with a zero byte
  strncpy(address.sun_path + 1, name, sizeof address.sun_path - 2);
  const socklen_t bytes = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + strlen(address.sun_path + 1));
  const int bus = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  while (connect(bus, (struct sockaddr*)&address, bytes) != 0) usleep(10000);  // the controller listens
  struct device device = new_device(bus);
  struct timespec due;
  clock_gettime(CLOCK_MONOTONIC, &due);
  due.tv_nsec = due.tv_nsec / 1000000 * 1000000 + 750000;  // the loop ticks at 250,000
  while (step(&device)) {
    if ((due.tv_nsec += 1000000) >= 1000000000) due.tv_nsec -= 1000000000, ++due.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
  }
  printf("the controller has gone; the hand felt at most %.2f N in %.1f s\n", device.felt_N, device.ticks * 1e-3);
  return 0;
}
