#include "sim_host/run/host_time.h"

#include <thread>

namespace palpate {

bool RealHostTime::next() {
  if (!first_) std::this_thread::sleep_for(period_);
  first_ = false;
  return true;
}

double RealHostTime::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool VirtualHostTime::next() {
  if (paced_) std::this_thread::sleep_until(start_ + std::chrono::nanoseconds(look_ns_));
  turns_.wait_until(look_ns_);
  look_ns_ += std::chrono::nanoseconds(period_).count();
  return turns_.connected();
}

}  // namespace palpate
