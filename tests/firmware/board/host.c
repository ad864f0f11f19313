/* The exercise on this computer: prints its hash. Usage: host STEPS */
#include <stdio.h>
#include <stdlib.h>

#include "tests/firmware/board/exercise.h"

int main(int argc, char** argv) {
  printf("%08x\n", (unsigned)exercise(argc > 1 ? atoi(argv[1]) : 0));
  return 0;
}
