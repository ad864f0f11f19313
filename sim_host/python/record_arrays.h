// Tick records as NumPy's structured arrays: the bytes of TickRecord and RegionRecord themselves, under flat names.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "rt_core/record.h"

namespace palpate {

// One row of a tick is a TickRecord up to its regions.
pybind11::dtype tick_dtype();
// One row of a region: the tick's sequence and number, then a RegionRecord.
pybind11::dtype region_dtype();
// (name, meaning) of every field of both.
pybind11::list tick_fields();
pybind11::list region_fields();

// Collects records; then hands its memory over.
class RecordArrays {
 public:
  void reserve(std::size_t ticks);
  void add(const TickRecord& record);
  std::size_t size() const { return count_; }
  // (ticks, regions); this is empty then.
  pybind11::tuple take();

 private:
  std::size_t count_ = 0;
  std::vector<std::byte> ticks_, regions_;
};

}  // namespace palpate
