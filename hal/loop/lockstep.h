// Virtual time that several processes share, in lock step over sockets: time moves only when the leader waits, and only
// after everybody who had something to do before then has done it. What runs in it gives the same bits on any machine
// under any load; how long that takes is nobody's input.
//
//   leader (the controller)               follower (device, host)
//   wait_until(t): time is t
//     if follower's next <= t:   Turn{t}  ->   wait_until(d) returns for every d <= t, in order
//     blocks                  <- Turn{d}       wait_until(d) with d > t: done, nothing to do before d
//
// One message of one SOCK_SEQPACKET pair at a time; nobody spins. A follower that closes its end or does not answer for
// kTurnTimeout_ms of real time is dropped: time then goes on without it, so that the controller meets what it would
// meet on a wire, a device or a host that is silent, and reacts as it does there.
#pragma once

#include <atomic>
#include <cstdint>

namespace palpate {

// A follower works for microseconds per turn; only a stopped or hanging process takes this long.
inline constexpr int kTurnTimeout_ms = 10'000;
// A follower gives the leader up after this: every other follower may have used its whole time in between.
inline constexpr int kLeaderTimeout_ms = 3 * kTurnTimeout_ms;

// The leader's clock; a Clock of the loop. Its system calls are send and recv.
class LockstepClock {
 public:
  static constexpr int kMostFollowers = 3;  // two devices and the host

  explicit LockstepClock(int timeout_ms = kTurnTimeout_ms) noexcept : timeout_ms_(timeout_ms) {}
  // `fd` stays the caller's; `name` is static text. In each step followers have their turns in the order they were
  // added.
  void add(int fd, const char* name) noexcept;
  std::int64_t now_ns() const noexcept { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) noexcept;

  // The first follower that was dropped, or null; when, and whether it closed its end (otherwise it was silent).
  const char* lost() const noexcept { return lost_; }
  std::int64_t lost_ns() const noexcept { return lost_ns_; }
  bool lost_closed() const noexcept { return lost_closed_; }

 private:
  struct Follower {
    int fd = -1;  // -1: dropped
    const char* name = "";
    std::int64_t next_ns = 0;
  };
  void hand_over(Follower& follower) noexcept;

  Follower follower_[kMostFollowers];
  int timeout_ms_;
  int count_ = 0;
  std::int64_t now_ns_ = 0;
  const char* lost_ = nullptr;
  std::int64_t lost_ns_ = 0;
  bool lost_closed_ = false;
};

// A follower's clock; a Clock as well. Starts at 0, as the leader's does.
class FollowerClock {
 public:
  // `fd` stays the caller's. A wait ends early once `stop` is set.
  FollowerClock(int fd, const std::atomic<bool>& stop) noexcept;
  std::int64_t now_ns() const noexcept { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) noexcept;
  // False once the leader has closed its end or was silent for kLeaderTimeout_ms: waits return at once then.
  bool connected() const noexcept { return connected_; }

 private:
  int fd_;
  const std::atomic<bool>& stop_;
  std::int64_t now_ns_ = 0;
  std::int64_t granted_ns_ = -1;  // the leader's time at this turn
  bool my_turn_ = false;
  bool connected_ = true;
};

}  // namespace palpate
