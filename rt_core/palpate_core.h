// The component `core` in one header: open a baked image, tick, read what came out. No vector types, nothing that
// throws. docs/library.md tells how to build with it.
#pragma once

#include "rt_core/image.h"
#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/record.h"
#include "rt_core/state.h"
#include "rt_core/tick.h"
#include "rt_core/version.h"
