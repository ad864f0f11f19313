// The component `host` in one header: bake a scene, keep the memory of its ticks, press it without a device, read and
// replay recordings. Errors are exceptions here. docs/library.md tells how to build with it.
#pragma once

#include "rt_core/palpate_core.h"
#include "sim_host/bake/scene_image.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/press/press.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "sim_host/tick_memory.h"
