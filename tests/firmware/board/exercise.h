/* A stretch of a node's life that meets every branch of it, the same on every processor: on a host and on a Cortex-M4
 * its hash must be equal. */
#ifndef PALPATE_EXERCISE_H
#define PALPATE_EXERCISE_H

#include <stdint.h>

/* Hash (FNV-1a) of every bit that the motors were given and the bus was sent, in `steps` steps of control. */
uint32_t exercise(int steps);

#endif
