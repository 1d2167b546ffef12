#pragma once
/// One writer of a folder at a time.
#include <chrono>
#include <filesystem>

namespace bough::io {

/// A lock on a folder that ends with the process, however that ends.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock() { release(); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// False if another process holds the lock, or if the folder no longer exists under this name. On file systems
  /// without locks, the folder counts as locked by this process.
  [[nodiscard]] bool take(const std::filesystem::path& folder);
  /// Takes the lock as soon as it is free; false if it is not within this time, or if the folder vanishes.
  [[nodiscard]] bool wait(const std::filesystem::path& folder, std::chrono::milliseconds most);
  void release();

 private:
  int descriptor_ = -1;
};

}  // namespace bough::io
