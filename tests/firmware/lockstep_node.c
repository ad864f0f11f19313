/* The firmware's node with a simulated hand, in the controller's virtual time (hal/loop/lockstep.h), started as
 * palpate-device is. Ten steps of control to a millisecond. */
#include <errno.h>
#include <linux/can.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

#include "hal/firmware/haptic_node.h"

enum { kControl_Hz = 10000, kStepsPerPeriod = 10 };

struct device {
  int bus;
  struct hn_node node;
  struct hn_motors motors;
  double position_m[3], velocity[3], time_s;
};

/* 0 when the controller has gone. */
static int take_all(struct device* d) {
  struct canfd_frame frame;
  ssize_t bytes;
  while ((bytes = recv(d->bus, &frame, sizeof frame, MSG_DONTWAIT)) > 0)
    if (bytes == sizeof frame && frame.len <= sizeof frame.data) hn_take(&d->node, frame.can_id, frame.data, frame.len);
  return bytes != 0 && errno == EAGAIN;
}

/* The hand of docs/examples/device.c: it aims 28 mm down and up again every 2 s, and pulls like a spring. */
static void step_control(struct device* d, int32_t position[3]) {
  const double dt_s = 1.0 / (double)kControl_Hz;
  const double aim_m[3] = {-0.010, 0.076 + 0.014 * cos(3.14159265358979 * d->time_s), 0};
  for (int i = 0; i < 3; ++i) position[i] = (int32_t)lround(d->position_m[i] * 1e7);
  hn_control(&d->node, position, &d->motors);
  for (int i = 0; i < 3; ++i) {
    const double pull_N = 800 * (aim_m[i] - d->position_m[i]) - 10 * d->velocity[i];
    d->velocity[i] += dt_s * (pull_N + (double)d->motors.force_N[i]) / 0.2;
    d->position_m[i] += dt_s * d->velocity[i];
  }
  d->time_s += dt_s;
}

static int step(struct device* d) {
  struct hn_handle handle = {.quaternion = {32767, 0, 0, 0}};
  struct hn_frame status;
  struct canfd_frame frame = {.flags = CANFD_BRS};
  if (!take_all(d)) return 0;
  for (int i = 0; i < kStepsPerPeriod; ++i) step_control(d, handle.position);
  hn_status(&d->node, &handle, (uint32_t)lround(d->time_s * 1e6), &status);
  frame.can_id = status.identifier;
  frame.len = status.length;
  memcpy(frame.data, status.data, status.length);
  send(d->bus, &frame, sizeof frame, MSG_DONTWAIT | MSG_NOSIGNAL);
  return 1;
}

static int descriptor(int argc, char** argv, const char* option) {
  for (int i = 1; i + 1 < argc; ++i)
    if (strcmp(argv[i], option) == 0) return atoi(argv[i + 1]);
  exit(2);
}

int main(int argc, char** argv) {
  /* First argument, if any: the stiffness it keeps, N/m; with it the node offers the local model. */
  const struct hn_config config = {.number = 1,
                                   .control_Hz = kControl_Hz,
                                   .force_max_N = 8.5f,
                                   .stiffness_max_N_per_m = argc > 1 && argv[1][0] != '-' ? (float)atof(argv[1]) : 0};
  const int turns = descriptor(argc, argv, "--turn-fd");
  struct device device = {.bus = descriptor(argc, argv, "--device-fd"), .position_m = {-0.010, 0.090, 0}};
  if (!hn_init(&device.node, &config)) return 2;
  hn_set_calibrated(&device.node, true);
  const int64_t period_ns = 1000000;
  int64_t now_ns, due_ns = period_ns;
  while (recv(turns, &now_ns, sizeof now_ns, 0) == sizeof now_ns) {
    for (; due_ns <= now_ns; due_ns += period_ns)
      if (!step(&device)) return 0;
    if (send(turns, &due_ns, sizeof due_ns, MSG_NOSIGNAL) != sizeof due_ns) return 0;
  }
}
