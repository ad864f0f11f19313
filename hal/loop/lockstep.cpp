#include "hal/loop/lockstep.h"

#include <sys/socket.h>
#include <sys/time.h>

#include <cerrno>

namespace palpate {

namespace {

struct Turn {
  std::int64_t time_ns;
};

void limit_waiting(int fd, int timeout_ms) noexcept {
  const timeval limit{timeout_ms / 1000, (timeout_ms % 1000) * 1000};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

bool put(int fd, std::int64_t time_ns) noexcept {
  const Turn turn{time_ns};
  return ::send(fd, &turn, sizeof turn, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof turn);
}

enum class Got { kTurn, kNothingYet, kClosed };

// Waits at most the socket's limit; a signal ends it early.
Got get(int fd, std::int64_t& time_ns) noexcept {
  Turn turn;
  const ssize_t bytes = ::recv(fd, &turn, sizeof turn, 0);
  if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return Got::kNothingYet;
  if (bytes != static_cast<ssize_t>(sizeof turn)) return Got::kClosed;
  time_ns = turn.time_ns;
  return Got::kTurn;
}

// So long one recv waits: a signal's flag is looked at as often.
constexpr int kPoll_ms = 100;

}  // namespace

void LockstepClock::add(int fd, const char* name) noexcept {
  if (count_ == kMostFollowers) return;
  limit_waiting(fd, kPoll_ms);
  follower_[count_++] = {fd, name, 0};
}

void LockstepClock::hand_over(Follower& follower) noexcept {
  Got got = put(follower.fd, now_ns_) ? Got::kNothingYet : Got::kClosed;
  // Signals shorten a wait; nobody sends them by the hundred.
  for (int i = 0; got == Got::kNothingYet && i < timeout_ms_ / kPoll_ms; ++i) got = get(follower.fd, follower.next_ns);
  if (got == Got::kTurn) return;
  follower.fd = -1;
  if (lost_ != nullptr) return;
  lost_ = follower.name;
  lost_ns_ = now_ns_;
  lost_closed_ = got == Got::kClosed;
}

void LockstepClock::wait_until(std::int64_t deadline_ns) noexcept {
  if (now_ns_ < deadline_ns) now_ns_ = deadline_ns;
  for (int i = 0; i < count_; ++i)  // bound: kMostFollowers
    if (follower_[i].fd >= 0 && follower_[i].next_ns <= now_ns_) hand_over(follower_[i]);
}

FollowerClock::FollowerClock(int fd, const std::atomic<bool>& stop) noexcept : fd_(fd), stop_(stop) {
  limit_waiting(fd, kPoll_ms);
}

void FollowerClock::wait_until(std::int64_t deadline_ns) noexcept {
  int silent = 0;
  while (connected_ && granted_ns_ < deadline_ns && !stop_.load(std::memory_order_relaxed)) {
    if (my_turn_) connected_ = put(fd_, deadline_ns);
    my_turn_ = false;
    const Got got = connected_ ? get(fd_, granted_ns_) : Got::kClosed;
    my_turn_ = got == Got::kTurn;
    if (got == Got::kClosed || ++silent > kLeaderTimeout_ms / kPoll_ms) connected_ = false;
    if (got == Got::kTurn) silent = 0;
  }
  if (now_ns_ < deadline_ns) now_ns_ = deadline_ns;
}

}  // namespace palpate
