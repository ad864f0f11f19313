#include "haptic_node.h"

enum {
  kCommand = 0x100,
  kLocalCommand = 0x130,
  kStatus = 0x180,
  kVersion = 2,
  kEnable = 1,     /* flag of a command */
  kCalibrated = 1, /* flags of a status */
  kEnabled = 2,
  kStopPressed = 4,
  kError = 8,
  kLetGo = 16,
  kCut = 32,
  kLocalModel = 64,
  kWatchdog_per_s = 50, /* 20 ms */
  kOldRange = 0x4000,   /* numbers up to a quarter of the range behind are old */
  kRestart = 4          /* old ones in a row are a sender that began anew */
};

static const float kForceStep_N = 1e-3f, kTorqueStep_Nm = 1e-4f, kStiffnessStep_N_per_m = 1e-2f, kPointStep_m = 1e-7f;
static const int32_t kValidMost = 50;            /* of 0.1 ms */
static const float kSlopePerSecond = 100.0f;     /* of the limit: a tenth in a millisecond */
static const float kLocalSlopePerSecond = 90.0f; /* of a node with the local model: with its encoder's steps no more */
static const float kEncoderPerSecond = 1.3e3f;   /* steps that a smoothed encoder may be off by, a millisecond */
static const float kFineEncoderPerSecond = 8.0f; /* what steps may make beside that slope */
static const float kFarthestPerSecond = 2e7f;    /* 2 m/s in steps of the position: no hand that explores */
static const double kRounding_N_per_m = 0.015;   /* three entries of a row are off by half a step each */

/* CRC-16/CCITT-FALSE, four bits at a time: a table of 32 bytes. */
static uint16_t crc_nibbles(uint16_t crc, const uint8_t* bytes, uint32_t count) {
  static const uint16_t kTable[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5, 0x60C6, 0x70E7,
                                      0x8108, 0x9129, 0xA14A, 0xB16B, 0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};
  for (uint32_t i = 0; i < count; ++i) {
    crc = (uint16_t)(crc << 4 ^ kTable[(crc >> 12 ^ bytes[i] >> 4) & 15]);
    crc = (uint16_t)(crc << 4 ^ kTable[(crc >> 12 ^ bytes[i]) & 15]);
  }
  return crc;
}

static uint16_t seal_of(uint16_t identifier, const uint8_t* data, uint32_t count) {
  const uint8_t begin[2] = {(uint8_t)identifier, (uint8_t)(identifier >> 8)};
  return crc_nibbles(crc_nibbles(0xFFFF, begin, 2), data, count);
}

static uint16_t get16(const uint8_t* from) { return (uint16_t)(from[0] | from[1] << 8); }
static int32_t get16s(const uint8_t* from) { return (int16_t)get16(from); }
static int32_t get24s(const uint8_t* from) {
  const uint32_t bits = (uint32_t)from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16;
  return (int32_t)(bits ^ 0x800000u) - 0x800000;
}
static uint8_t* put(uint8_t* to, int bytes, uint32_t value) {
  for (; bytes > 0; --bytes, value >>= 8) *to++ = (uint8_t)value;
  return to;
}

static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static float size_of(const float v[3]) { return __builtin_sqrtf(dot(v, v)); }
static void clear(float v[3]) { v[0] = v[1] = v[2] = 0; }

/* No principal minor of K + small I is below zero. In double precision, which this processor emulates, once a command:
 * the determinant of a contact's tangent is small^2 k, 1e-12 of the products it is made of. */
static bool is_semi_definite(const float along[3], const float across[3]) {
  const double trace = (double)along[0] + (double)along[1] + (double)along[2];
  const double small = (trace > 0 ? 1e-6 * trace : 0) + kRounding_N_per_m;
  const double x = (double)along[0] + small, y = (double)along[1] + small, z = (double)along[2] + small;
  const double a = (double)across[0], b = (double)across[1], c = (double)across[2];
  const double xy = x * y - c * c, xz = x * z - b * b, yz = y * z - a * a;
  const double all = x * yz - c * (c * z - a * b) + b * (c * a - y * b);
  return x >= 0 && y >= 0 && z >= 0 && xy >= 0 && xz >= 0 && yz >= 0 && all >= 0;
}

static float larger(float a, float b) { return a > b ? a : b; }

/* Along any line, at most: no eigenvalue is larger than the root of the squares of all nine entries, nor than the
 * largest row of sizes. */
static float stiffness_of(const struct hn_command* model) {
  const float *d = model->along_N_per_m, *o = model->across_N_per_m;
  const float x = __builtin_fabsf(o[0]), y = __builtin_fabsf(o[1]), z = __builtin_fabsf(o[2]);
  const float row =
      larger(__builtin_fabsf(d[0]) + z + y, larger(__builtin_fabsf(d[1]) + z + x, __builtin_fabsf(d[2]) + y + x));
  const float root = __builtin_sqrtf(dot(d, d) + 2 * dot(o, o));
  return row < root ? row : root;
}

/* The model of a command, within what the device keeps; none when it is not one. */
static void take_model(const struct hn_config* config, const uint8_t* data, struct hn_command* command) {
  const int32_t valid = data[45];
  if (valid == 0 || valid > kValidMost) return;
  for (int i = 0; i < 3; ++i) {
    command->along_N_per_m[i] = (float)get24s(data + 18 + 3 * i) * kStiffnessStep_N_per_m;
    command->across_N_per_m[i] = (float)get24s(data + 27 + 3 * i) * kStiffnessStep_N_per_m;
    command->point[i] = get24s(data + 36 + 3 * i);
  }
  if (!is_semi_definite(command->along_N_per_m, command->across_N_per_m)) return;
  const float size = stiffness_of(command);
  if (size > config->stiffness_max_N_per_m) {
    const float scale = config->stiffness_max_N_per_m / size;
    for (int i = 0; i < 3; ++i) {
      command->along_N_per_m[i] *= scale;
      command->across_N_per_m[i] *= scale;
    }
  }
  command->valid_steps = valid * config->control_Hz / 10000;
}

/* Whether a command of this number is new. Twice, or late: not; but four that follow one another are of a controller
 * that has started again. */
static bool is_new(struct hn_node* node, uint16_t number) {
  if (node->heard && (uint16_t)(node->echo - number) < kOldRange) {
    node->old_run = number == (uint16_t)(node->old + 1) ? (uint8_t)(node->old_run + 1) : 1;
    node->old = number;
    if (node->old_run < kRestart) return false;
  }
  node->heard = true;
  node->echo = number;
  node->old_run = 0;
  return true;
}

bool hn_init(struct hn_node* node, const struct hn_config* config) {
  *node = (struct hn_node){.config = *config, .enabled = true, .let_go = true};
  const bool is_right = config->number >= 1 && config->number <= 15 && config->control_Hz >= 1000 &&
                        config->control_Hz <= 20000 && config->force_max_N > 0 && config->torque_max_Nm >= 0 &&
                        config->stiffness_max_N_per_m >= 0 && config->encoder_step_m >= 0;
  if (!is_right) node->config = (struct hn_config){.number = 0, .control_Hz = 1000};
  return is_right;
}

void hn_take(struct hn_node* node, uint32_t identifier, const uint8_t* data, uint32_t length) {
  const uint32_t own = (uint32_t)node->config.number;
  const bool is_local =
      identifier == kLocalCommand + own && length == HN_LOCAL_COMMAND_BYTES && node->config.stiffness_max_N_per_m > 0;
  const bool is_command = is_local || (identifier == kCommand + own && length == HN_COMMAND_BYTES);
  if (own == 0 || !is_command || get16(data + length - 2) != seal_of((uint16_t)identifier, data, length - 2) ||
      !is_new(node, get16(data))) {
    node->refused += 1;
    return;
  }
  const bool enable = (get16(data + 4) & kEnable) != 0;
  if (enable && !node->enabled) node->let_go = false;
  node->enabled = enable;
  node->silent_steps = node->age_steps = 0;
  node->obeyed += 1;
  struct hn_command* command = &node->command;
  command->valid_steps = 0;
  for (int i = 0; i < 3; ++i) {
    command->force_N[i] = (float)get16s(data + 6 + 2 * i) * kForceStep_N;
    command->torque_Nm[i] = (float)get16s(data + 12 + 2 * i) * kTorqueStep_Nm;
    node->wanted_N[i] = command->force_N[i];
  }
  if (is_local) take_model(&node->config, data, command);
}

/* F - K (x - p), which does not turn round against F: what has gone beyond the surface is not pulled back. */
static void evaluate_model(const struct hn_command* command, const int32_t position[3], float force_N[3]) {
  const float *d = command->along_N_per_m, *o = command->across_N_per_m;
  float x[3];
  for (int i = 0; i < 3; ++i) x[i] = (float)(position[i] - command->point[i]) * kPointStep_m;
  force_N[0] = command->force_N[0] - (d[0] * x[0] + o[2] * x[1] + o[1] * x[2]);
  force_N[1] = command->force_N[1] - (o[2] * x[0] + d[1] * x[1] + o[0] * x[2]);
  force_N[2] = command->force_N[2] - (o[1] * x[0] + o[0] * x[1] + d[2] * x[2]);
  const float square = dot(command->force_N, command->force_N);
  const float along = dot(force_N, command->force_N);
  if (!(square > 0) || !(along < 0)) return;
  for (int i = 0; i < 3; ++i) force_N[i] -= along / square * command->force_N[i];
}

/* Whether it was longer than that. */
static bool shorten(float v[3], float most) {
  const float size = size_of(v);
  if (!(size > most)) return false;
  for (int i = 0; i < 3; ++i) v[i] *= most / size;
  return true;
}

/* Towards what is wanted, by no more than that. */
static void approach(float rendered[3], const float wanted[3], float slope) {
  float change[3];
  for (int i = 0; i < 3; ++i) change[i] = wanted[i] - rendered[i];
  shorten(change, slope);
  for (int i = 0; i < 3; ++i) rendered[i] += change[i];
}

/* Of a step of control; under a model a coarse encoder through its stiffness leaves less. */
static float force_slope(const struct hn_config* config, const struct hn_command* model) {
  float share = config->stiffness_max_N_per_m > 0 ? kLocalSlopePerSecond : kSlopePerSecond;
  if (model) {
    const float steps = kEncoderPerSecond * stiffness_of(model) * config->encoder_step_m / config->force_max_N;
    const float less = steps > kFineEncoderPerSecond ? steps - kFineEncoderPerSecond : 0;
    share -= less < 0.5f * share ? less : 0.5f * share;
  }
  return share * config->force_max_N / (float)config->control_Hz;
}
static float torque_slope(const struct hn_config* config) {
  return kSlopePerSecond * config->torque_max_Nm / (float)config->control_Hz;
}

/* What the model says of the handle's own way in a step, none of it when that is an encoder's jump. */
static void add_way(const struct hn_node* node, const int32_t position[3], const float wanted[3], float rendered[3]) {
  float before[3], square = 0;
  for (int i = 0; i < 3; ++i) {
    const float way = (float)(position[i] - node->position[i]);
    square += way * way;
  }
  const float farthest = kFarthestPerSecond / (float)node->config.control_Hz;
  if (square > farthest * farthest) return;
  evaluate_model(&node->command, node->position, before);
  shorten(before, node->config.force_max_N);
  for (int i = 0; i < 3; ++i) rendered[i] += wanted[i] - before[i];
}

/* The handle's way acts at once, what commands changed with the slope; never above the limit, nor turned farther round
 * against F than it was. */
static void render_force(struct hn_node* node, const int32_t position[3], bool goes_on) {
  const float most = node->config.force_max_N, *sense = node->command.force_N;
  float *rendered = node->motors.force_N, wanted[3];
  for (int i = 0; i < 3; ++i) wanted[i] = node->wanted_N[i];
  node->is_cut = shorten(wanted, most) || node->is_cut;
  const float against = dot(rendered, sense), square = dot(sense, sense);
  if (goes_on) add_way(node, position, wanted, rendered);
  approach(rendered, wanted, force_slope(&node->config, goes_on ? &node->command : 0));
  const float over = (against < 0 ? against : 0) - dot(rendered, sense);
  if (square > 0 && over > 0)
    for (int i = 0; i < 3; ++i) rendered[i] += over / square * sense[i];
  shorten(rendered, most);
}

/* Torque is held: the slope alone. */
static void render_torque(struct hn_node* node) {
  float wanted[3];
  for (int i = 0; i < 3; ++i) wanted[i] = node->command.torque_Nm[i];
  node->is_cut = shorten(wanted, node->config.torque_max_Nm) || node->is_cut;
  approach(node->motors.torque_Nm, wanted, torque_slope(&node->config));
}

void hn_control(struct hn_node* node, const int32_t position[3], struct hn_motors* motors) {
  const struct hn_config* config = &node->config;
  static const float kNone[3] = {0, 0, 0};
  if (node->silent_steps <= config->control_Hz) node->silent_steps += 1;
  if (node->silent_steps * kWatchdog_per_s > config->control_Hz) node->enabled = node->let_go = true;
  const bool goes_on = node->age_steps < node->command.valid_steps;
  if (goes_on) {
    node->age_steps += 1;
    evaluate_model(&node->command, position, node->wanted_N);
  }
  if (node->stop_pressed || node->error != 0 || config->number == 0) {
    clear(node->motors.force_N);
    clear(node->motors.torque_Nm);
  } else if (node->enabled && !node->let_go) {
    render_force(node, position, goes_on);
    if (config->torque_max_Nm > 0) render_torque(node);
  } else {
    approach(node->motors.force_N, kNone, force_slope(config, 0));
    approach(node->motors.torque_Nm, kNone, torque_slope(config));
  }
  for (int i = 0; i < 3; ++i) node->position[i] = position[i];
  *motors = node->motors;
}

void hn_status(struct hn_node* node, const struct hn_handle* handle, uint32_t time_us, struct hn_frame* frame) {
  const unsigned flags = (node->calibrated ? kCalibrated : 0u) | (node->enabled && !node->let_go ? kEnabled : 0u) |
                         (node->stop_pressed ? kStopPressed : 0u) | (node->error != 0 ? kError : 0u) |
                         (node->let_go ? kLetGo : 0u) | (node->is_cut ? kCut : 0u) |
                         (node->config.stiffness_max_N_per_m > 0 ? kLocalModel : 0u);
  node->is_cut = false;
  node->sent += 1;
  frame->identifier = (uint16_t)(kStatus + node->config.number);
  frame->length = HN_STATUS_BYTES;
  uint8_t* to = put(put(put(frame->data, 2, node->sent), 2, node->echo), 2, flags);
  to = put(put(put(to, 1, handle->buttons), 1, node->error), 4, time_us);
  for (int i = 0; i < 3; ++i) {
    const int32_t p = handle->position[i];
    to = put(to, 3, (uint32_t)(p > 0x7FFFFF ? 0x7FFFFF : p < -0x800000 ? -0x800000 : p));
  }
  for (int i = 0; i < 4; ++i) to = put(to, 2, (uint16_t)handle->quaternion[i]);
  to = put(to, 1, kVersion);
  put(to, 2, seal_of(frame->identifier, frame->data, HN_STATUS_BYTES - 2));
}
