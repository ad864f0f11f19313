#include "hal/system/file_lock.h"

#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cstdio>
#include <fstream>
#include <memory>

namespace palpate {

namespace {

std::string process_name(long pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/comm");
  std::string name;
  std::getline(file, name);
  return name;
}

}  // namespace

bool lock_exclusively(int fd) { return flock(fd, LOCK_EX | LOCK_NB) == 0; }

std::string lock_holder(int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0) return "another process";
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {  // bound: locks of the system
    // 1: FLOCK  ADVISORY  WRITE 4711 08:01:123456 0 EOF
    long pid = 0;
    unsigned major_number = 0, minor_number = 0;
    unsigned long long inode = 0;
    if (std::sscanf(line.c_str(), "%*d: FLOCK %*s WRITE %ld %x:%x:%llu", &pid, &major_number, &minor_number, &inode) !=
        4)
      continue;
    const bool same = inode == status.st_ino && major_number == major(status.st_dev) &&
                      minor_number == minor(status.st_dev) && pid > 0;
    if (same) return "process " + std::to_string(pid) + " (" + process_name(pid) + ")";
  }
  return "another process";
}

}  // namespace palpate
