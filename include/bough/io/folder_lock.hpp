#pragma once
/// One writer of a folder at a time.
#include <filesystem>

namespace bough::io {

/// A lock on a folder that ends with the process, however that ends.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock() { release(); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// False where another process holds it, or where the folder is not there under this name. Folders of file systems
  /// without locks count as taken by this process.
  [[nodiscard]] bool take(const std::filesystem::path& folder);
  void release();

 private:
  int descriptor_ = -1;
};

}  // namespace bough::io
