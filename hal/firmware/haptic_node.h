/* The open haptic node's end of the wire protocol (docs/wire_protocol.md, CAN FD) for a microcontroller: commands
 * checked and followed, watchdog and its latch, limits and slope of the force, the local contact model, statuses.
 * Portable C11: no heap, no library but the compiler's own, single precision in the control loop; the same code runs on
 * this computer under `palpate device-test` and on a Cortex-M4 (docs/firmware.md).
 *
 * All functions are called from one context, or from contexts that cannot interrupt each other: a frame handed over by
 * an interrupt waits in a queue of the board's. None of them waits; each has a bounded number of steps.
 *
 *   once:                      hn_init
 *   for every frame:           hn_take
 *   control_Hz times a second: hn_control        encoders in, motors out
 *   1,000 times a second:      hn_status         a frame to send
 */
#ifndef PALPATE_HAPTIC_NODE_H
#define PALPATE_HAPTIC_NODE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { HN_STATUS_BYTES = 32, HN_COMMAND_BYTES = 20, HN_LOCAL_COMMAND_BYTES = 48 };

struct hn_config {
  int number;                  /* of the node, 1 to 15 */
  int control_Hz;              /* 1,000 to 20,000 */
  float force_max_N;           /* above 0 */
  float torque_max_Nm;         /* 0: no motors for it */
  float stiffness_max_N_per_m; /* that the device keeps at control_Hz; 0: no local model is offered */
  float encoder_step_m;        /* of the handle; 0 or more. Only a local model asks for it */
};

/* Positions in 0.1 um, device frame; orientation in 2^-15, w x y z, handle to device frame. */
struct hn_handle {
  int32_t position[3];
  int16_t quaternion[4];
  uint8_t buttons;
};

struct hn_motors {
  float force_N[3];
  float torque_Nm[3];
};

struct hn_frame {
  uint16_t identifier;
  uint8_t length;
  uint8_t data[HN_STATUS_BYTES];
};

/* What one command asks for. */
struct hn_command {
  float force_N[3];
  float torque_Nm[3];
  float along_N_per_m[3];  /* xx, yy, zz; of the local model */
  float across_N_per_m[3]; /* yz, xz, xy */
  int32_t point[3];        /* 0.1 um */
  int32_t valid_steps;     /* of control; 0: no local model, the force is held */
};

struct hn_node {
  struct hn_config config;
  struct hn_command command;
  struct hn_motors motors;
  float wanted_N[3];   /* newest, before limit and slope: what is held when a local model ends */
  int32_t position[3]; /* of the step before */
  int32_t silent_steps, age_steps;
  uint16_t echo, old, sent;
  uint8_t old_run, error;
  bool heard, enabled, let_go, stop_pressed, calibrated, is_cut;
  uint32_t obeyed, refused; /* counted, for the board's own use */
};

/* False, and a node that renders nothing, when a setting is out of its range. After power-up the force is zero until
 * enable goes from 0 to 1. */
bool hn_init(struct hn_node* node, const struct hn_config* config);

/* One frame that arrived: anything at all. Numbers are little-endian whatever the processor's order. */
void hn_take(struct hn_node* node, uint32_t identifier, const uint8_t* data, uint32_t length);

/* One step of control. `position` as in hn_handle. */
void hn_control(struct hn_node* node, const int32_t position[3], struct hn_motors* motors);

/* The status of this millisecond. */
void hn_status(struct hn_node* node, const struct hn_handle* handle, uint32_t time_us, struct hn_frame* frame);

/* What the board knows. An error (not 0) and the emergency stop cut the motors at the next step of control. */
static inline void hn_set_calibrated(struct hn_node* node, bool calibrated) { node->calibrated = calibrated; }
static inline void hn_set_stop(struct hn_node* node, bool pressed) { node->stop_pressed = pressed; }
static inline void hn_set_error(struct hn_node* node, uint8_t code) { node->error = code; }

#ifdef __cplusplus
}
#endif

#endif
