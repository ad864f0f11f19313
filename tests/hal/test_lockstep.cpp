// Virtual time in lock step: everything due is done before time moves, in the same order whoever is slow; a follower
// that is gone or hangs is dropped and named.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hal/loop/clock.h"
#include "hal/loop/lockstep.h"

namespace palpate {
namespace {

static_assert(Clock<LockstepClock> && Clock<FollowerClock>);

struct Pair {
  Pair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, end), 0); }
  ~Pair() {
    for (const int fd : end)
      if (fd >= 0) close(fd);
  }
  void close_end(int which) {
    close(end[which]);
    end[which] = -1;
  }
  int end[2];
};

// Who did something, and when it was.
struct Journal {
  std::mutex mutex;
  std::string text;
  void add(const std::string& who, std::int64_t time_ns) {
    const std::lock_guard lock(mutex);
    text += who + std::to_string(time_ns) + " ";
  }
};

// Does something every `period_ns`, slowly every third time.
std::thread follower(int fd, const char* who, std::int64_t period_ns, Journal& journal, const std::atomic<bool>& stop,
                     int slow_ms) {
  return std::thread([=, &journal, &stop] {
    FollowerClock clock(fd, stop);
    for (std::int64_t t = period_ns, i = 0; clock.connected() && !stop.load(); t += period_ns, ++i) {
      clock.wait_until(t);
      if (!clock.connected()) return;
      if (i % 3 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(slow_ms));
      journal.add(who, clock.now_ns());
    }
  });
}

std::string journal_of(int slow_ms_a, int slow_ms_b) {
  Journal journal;
  std::atomic<bool> stop{false};
  Pair a, b;
  std::thread first = follower(a.end[1], "a", 10, journal, stop, slow_ms_a);
  std::thread second = follower(b.end[1], "b", 15, journal, stop, slow_ms_b);
  LockstepClock clock;
  clock.add(a.end[0], "a");
  clock.add(b.end[0], "b");
  for (std::int64_t t = 7; t <= 60; t += 7) {
    clock.wait_until(t);
    journal.add("tick", clock.now_ns());
  }
  EXPECT_EQ(clock.lost(), nullptr);
  a.close_end(0);
  b.close_end(0);
  first.join();
  second.join();
  return journal.text;
}

TEST(Lockstep, WhatIsDueIsDoneBeforeTimeMovesWhoeverIsSlow) {
  const std::string expected =
      "tick7 a10 tick14 a20 b15 tick21 tick28 a30 b30 tick35 a40 tick42 b45 tick49 a50 tick56 ";
  EXPECT_EQ(journal_of(0, 0), expected);
  EXPECT_EQ(journal_of(5, 0), expected);
  EXPECT_EQ(journal_of(0, 5), expected);
}

TEST(Lockstep, AFollowerThatClosesItsEndIsDroppedAndTimeGoesOn) {
  Pair pair;
  LockstepClock clock;
  clock.add(pair.end[0], "device");
  pair.close_end(1);
  clock.wait_until(1000);
  EXPECT_EQ(clock.now_ns(), 1000);
  EXPECT_STREQ(clock.lost(), "device");
  EXPECT_EQ(clock.lost_ns(), 1000);
  EXPECT_TRUE(clock.lost_closed());
  clock.wait_until(2000);
  EXPECT_EQ(clock.now_ns(), 2000);
}

TEST(Lockstep, AFollowerThatDoesNotAnswerIsDropped) {
  Pair pair;
  LockstepClock clock(200);
  clock.add(pair.end[0], "host");
  clock.wait_until(1000);
  EXPECT_STREQ(clock.lost(), "host");
  EXPECT_FALSE(clock.lost_closed());
}

TEST(Lockstep, AFollowerWhoseLeaderIsGoneWaitsForNobody) {
  Pair pair;
  const std::atomic<bool> stop{false};
  FollowerClock clock(pair.end[1], stop);
  pair.close_end(0);
  clock.wait_until(1000);
  EXPECT_FALSE(clock.connected());
  EXPECT_EQ(clock.now_ns(), 1000);
}

TEST(Lockstep, AFollowerToldToStopDoes) {
  Pair pair;
  const std::atomic<bool> stop{true};
  FollowerClock clock(pair.end[1], stop);
  clock.wait_until(1000);
  EXPECT_TRUE(clock.connected());
}

TEST(Lockstep, AMessageThatIsNoTurnEndsIt) {
  Pair pair;
  LockstepClock clock;
  clock.add(pair.end[0], "device");
  ASSERT_EQ(send(pair.end[1], "garbage", 3, 0), 3);
  clock.wait_until(1000);
  EXPECT_STREQ(clock.lost(), "device");
}

}  // namespace
}  // namespace palpate
