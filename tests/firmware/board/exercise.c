#include "tests/firmware/board/exercise.h"

#include "hal/firmware/haptic_node.h"

static uint32_t drawn = 1;
static uint32_t draw(void) { return drawn = drawn * 1664525u + 1013904223u, drawn >> 8; } /* Numerical Recipes */

static uint32_t hash_of(uint32_t hash, const void* bytes, uint32_t count) {
  for (const uint8_t* byte = bytes; count > 0; --count, ++byte) hash = (hash ^ *byte) * 16777619u;
  return hash;
}

static uint16_t crc_bit_by_bit(uint32_t identifier, const uint8_t* data, int count) {
  uint16_t crc = 0xFFFF;
  for (int i = -2; i < count; ++i) {
    crc ^= (uint16_t)((i < 0 ? (uint8_t)(identifier >> 8 * (i + 2)) : data[i]) << 8);
    for (int bit = 0; bit < 8; ++bit) crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
  }
  return crc;
}

/* A command of either kind: forces up to 32 N, a stiffness k n n^T in some direction up to 80,000 N/m, now and then
 * spoilt; a number that is mostly the next one. */
static int make_command(uint8_t* data, uint32_t* identifier, uint16_t* number) {
  const int is_local = draw() % 4 != 0, count = is_local ? HN_LOCAL_COMMAND_BYTES : HN_COMMAND_BYTES;
  *identifier = (is_local ? 0x130u : 0x100u) + 1;
  *number = (uint16_t)(*number + (draw() % 16 == 0 ? draw() : 1u));
  for (int i = 0; i < count; ++i) data[i] = 0;
  data[0] = (uint8_t)*number, data[1] = (uint8_t)(*number >> 8);
  data[4] = draw() % 32 != 0;
  for (int i = 6; i < 18; ++i) data[i] = (uint8_t)draw();
  if (is_local) {
    const int32_t n[3] = {(int32_t)(draw() % 2001) - 1000, (int32_t)(draw() % 2001) - 1000,
                          (int32_t)(draw() % 2001) - 1000};
    const int32_t scale = (int32_t)(draw() % 8) + 1, pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    for (int i = 0; i < 6; ++i) {
      const uint32_t entry = (uint32_t)(n[pair[i][0]] * n[pair[i][1]] * scale) + (draw() % 64 == 0 ? draw() : 0u);
      data[18 + 3 * i] = (uint8_t)entry, data[19 + 3 * i] = (uint8_t)(entry >> 8),
                    data[20 + 3 * i] = (uint8_t)(entry >> 16);
    }
    data[45] = (uint8_t)(draw() % 60);
  }
  const uint16_t seal = crc_bit_by_bit(*identifier, data, count - 2);
  data[count - 2] = (uint8_t)seal, data[count - 1] = (uint8_t)(seal >> 8);
  if (draw() % 32 == 0) data[draw() % (uint32_t)count] ^= 1;
  return count;
}

/* What a board does in a step in which everything comes together: this is what is measured. */
__attribute__((noinline)) void measured_step(struct hn_node* node, uint32_t identifier, const uint8_t* data,
                                             uint32_t length, const struct hn_handle* handle, struct hn_motors* motors,
                                             struct hn_frame* frame) {
  if (length > 0) hn_take(node, identifier, data, length);
  hn_control(node, handle->position, motors);
  if (frame) hn_status(node, handle, drawn, frame);
}

uint32_t exercise(int steps) {
  static struct hn_node node;
  const struct hn_config config = {.number = 1,
                                   .control_Hz = 10000,
                                   .force_max_N = 8.5f,
                                   .torque_max_Nm = 0.2f,
                                   .stiffness_max_N_per_m = 2000.0f,
                                   .encoder_step_m = 1e-4f};
  struct hn_handle handle = {.quaternion = {32767, 0, 0, 0}};
  uint32_t hash = 2166136261u;
  uint16_t number = 0;
  hn_init(&node, &config);
  hn_set_calibrated(&node, 1);
  for (int step = 0; step < steps; ++step) {
    uint8_t data[HN_LOCAL_COMMAND_BYTES];
    uint32_t identifier = 0;
    const int is_new = step % 10 == 0 || step % 400 > 390; /* every millisecond, and bursts */
    const int is_silent = step % 1000 > 700;
    const int length = is_new && !is_silent ? make_command(data, &identifier, &number) : 0;
    const int32_t reach = draw() % 8 == 0 ? 10000 : 1000; /* an encoder that jumps, or a hand */
    for (int i = 0; i < 3; ++i) handle.position[i] += (int32_t)(draw() % (uint32_t)(2 * reach + 1)) - reach;
    hn_set_stop(&node, step % 1200 > 1180);
    struct hn_motors motors;
    struct hn_frame frame;
    measured_step(&node, identifier, data, (uint32_t)length, &handle, &motors, is_new ? &frame : 0);
    hash = hash_of(hash, &motors, sizeof motors);
    if (is_new) hash = hash_of(hash, frame.data, sizeof frame.data);
  }
  return hash_of(hash, &node.obeyed, sizeof node.obeyed);
}
