#include "bough/io/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>

namespace bough::io {

namespace fs = std::filesystem;

bool FolderLock::take(const fs::path& folder) {
  release();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) return false;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor);
    return false;
  }
  struct stat locked = {}, named = {};  // the folder may have been renamed before it was locked
  const bool is_same = ::fstat(descriptor, &locked) == 0 && ::lstat(folder.c_str(), &named) == 0 &&
                       locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
  if (!is_same) {
    ::close(descriptor);
    return false;
  }
  descriptor_ = descriptor;
  return true;
}

bool FolderLock::wait(const fs::path& folder, std::chrono::milliseconds most) {
  constexpr auto at_first = std::chrono::milliseconds(2), at_most = std::chrono::milliseconds(50);
  const auto start = std::chrono::steady_clock::now();
  for (auto pause = at_first; !take(folder); pause = std::min(2 * pause, at_most)) {
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(folder, ignored)) || std::chrono::steady_clock::now() - start > most)
      return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

void FolderLock::release() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace bough::io
