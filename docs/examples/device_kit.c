// A haptic device in C: hal/firmware/haptic_node.c keeps the protocol's rules, this file has bus, handle and simulated
// hand.
//   cc -O2 -Ihal/firmware docs/examples/device_kit.c hal/firmware/haptic_node.c -o device -lm
//   ./device mine & palpate device-test loopback:mine
#define _GNU_SOURCE
#include <errno.h>
#include <linux/can.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "haptic_node.h"

struct device {
  int bus, ticks;
  struct hn_node node;
  double position_m[3], velocity[3];
};

static struct device new_device(int bus) {
  struct device d = {.bus = bus, .position_m = {-0.010, 0.090, 0}};
  const struct hn_config config = {.number = 1, .control_Hz = 1000, .force_max_N = 8.5f};
  hn_init(&d.node, &config);
  hn_set_calibrated(&d.node, true);
  return d;
}

static int step(struct device* d) {  // one millisecond: commands, motors, hand, status; 0 when the controller has gone
  struct canfd_frame in, out = {.flags = CANFD_BRS};
  ssize_t bytes;
  while ((bytes = recv(d->bus, &in, sizeof in, MSG_DONTWAIT)) > 0)
    if (bytes == sizeof in) hn_take(&d->node, in.can_id, in.data, in.len);
  if (bytes == 0 || errno != EAGAIN) return 0;
  struct hn_handle handle = {.quaternion = {32767}};
  struct hn_motors motors;
  for (int i = 0; i < 3; ++i) handle.position[i] = (int32_t)lround(1e7 * d->position_m[i]);  // encoders
  hn_control(&d->node, handle.position, &motors);
  for (int i = 0; i < 3; ++i) {  // in place of motors a hand, which a spring pulls down and up again every 2 s
    const double aim_m = i == 0 ? -0.010 : i == 1 ? 0.076 + 0.014 * cos(3.14159265358979e-3 * d->ticks) : 0;
    const double pull_N = 800 * (aim_m - d->position_m[i]) - 10 * d->velocity[i];
    d->velocity[i] += 1e-3 * (pull_N + (double)motors.force_N[i]) / 0.2;
    d->position_m[i] += 1e-3 * d->velocity[i];
    handle.position[i] = (int32_t)lround(1e7 * d->position_m[i]);
  }
  struct hn_frame status;
  hn_status(&d->node, &handle, 1000u * (uint32_t)++d->ticks, &status);
  out.can_id = status.identifier, out.len = status.length;
  memcpy(out.data, status.data, status.length);
  send(d->bus, &out, sizeof out, MSG_DONTWAIT | MSG_NOSIGNAL);
  return 1;
}

int main(int argc, char** argv) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};  // an abstract name begins with a zero byte
  strncpy(address.sun_path + 1, argc > 1 ? argv[1] : "palpate", sizeof address.sun_path - 2);
  const size_t bytes = offsetof(struct sockaddr_un, sun_path) + 1 + strlen(address.sun_path + 1);
  struct device device = new_device(socket(AF_UNIX, SOCK_SEQPACKET, 0));
  while (connect(device.bus, (struct sockaddr*)&address, (socklen_t)bytes) != 0) usleep(10000);
  struct timespec due;
  clock_gettime(CLOCK_MONOTONIC, &due);
  due.tv_nsec = due.tv_nsec / 1000000 * 1000000 + 750000;  // the loop ticks at 250,000
  while (step(&device)) {
    if ((due.tv_nsec += 1000000) >= 1000000000) due.tv_nsec -= 1000000000, ++due.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
  }
  return 0;
}
