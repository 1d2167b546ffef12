#include "bough/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include "error_text.hpp"

namespace bough::io {
namespace {

constexpr std::size_t flush_at = std::size_t{1} << 16;

/// Writes all bytes; returns 0 or the error.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    if (written == 0) return EIO;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

int sync_descriptor(int descriptor) {
  while (::fsync(descriptor) != 0) {
    if (errno == EINTR) continue;
    return errno == EINVAL || errno == ENOTSUP ? 0 : errno;
  }
  return 0;
}

void sync_path(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags);
  const int error = descriptor < 0 ? errno : sync_descriptor(descriptor);
  if (descriptor >= 0) ::close(descriptor);
  if (error != 0) throw std::runtime_error("cannot make " + path.string() + " durable: " + error_text(error));
}

/// Opens a file for writing, never with the descriptor of a standard stream: if the process was started with one of
/// them closed, text printed to it would go to the file. Returns -1 with the reason in errno if the file cannot be
/// opened.
int open_to_write(const char* path) {
  const int descriptor = ::open(path, O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0 || descriptor > STDERR_FILENO) return descriptor;
  const int higher = ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return higher;
}

}  // namespace

void sync_directory(const std::filesystem::path& directory) {
  sync_path(directory.empty() ? "." : directory, O_DIRECTORY);
}

void sync_file(const std::filesystem::path& path) { sync_path(path, 0); }

AtomicFile::AtomicFile(std::filesystem::path final_path) : AtomicFile(std::move(final_path), Content::replaced) {}

std::unique_ptr<AtomicFile> AtomicFile::reopen(std::filesystem::path final_path) {
  std::filesystem::path partial = final_path;
  partial += ".partial";
  if (std::error_code ignored; !std::filesystem::exists(std::filesystem::symlink_status(partial, ignored)) &&
                               ::rename(final_path.c_str(), partial.c_str()) != 0)
    throw std::runtime_error("cannot go on with " + final_path.string() + ": " + error_text(errno));
  return std::unique_ptr<AtomicFile>(new AtomicFile(std::move(final_path), Content::kept));
}

AtomicFile::AtomicFile(std::filesystem::path final_path, Content content)
    : final_path_(std::move(final_path)), partial_path_(final_path_) {
  // Only regular files and links to them are replaced. A rename would put a file in the place of a device, a pipe or a
  // link to a folder.
  std::error_code ignored;
  const std::filesystem::file_status there = std::filesystem::status(final_path_, ignored);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
    throw std::runtime_error("cannot write " + final_path_.string() + ": it is not a regular file");
  }
  partial_path_ += ".partial";
  // The file is truncated only after it is locked: another run may be writing it.
  const int descriptor = open_to_write(partial_path_.c_str());
  if (descriptor < 0) fail(errno);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor);
    throw BeingWritten("cannot write " + final_path_.string() + ": another run is writing it");
  }
  if (content == Content::replaced && ::ftruncate(descriptor, 0) != 0) {
    const int error = errno;
    ::close(descriptor);
    fail(error);
  }
  descriptor_ = descriptor;
  keeps_ = content == Content::kept;
  if (keeps_) flushed_ = std::filesystem::file_size(partial_path_);
}

AtomicFile::~AtomicFile() {
  if (keeps_ && descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  give_up();
}

void AtomicFile::give_up() {
  if (descriptor_ < 0) return;
  ::unlink(partial_path_.c_str());
  ::close(descriptor_);
  descriptor_ = -1;
}

void AtomicFile::fail(int error) const {
  throw std::runtime_error("cannot write " + final_path_.string() + ": " + error_text(error));
}

void AtomicFile::write(std::string_view bytes) {
  buffer_ += bytes;
  if (buffer_.size() >= flush_at) flush();
}

void AtomicFile::flush() {
  if (descriptor_ < 0) throw std::logic_error("AtomicFile: written after commit");
  if (buffer_.empty()) return;
  keeps_ = false;
  const int error = write_all(descriptor_, buffer_);
  if (error == 0) {
    flushed_ += buffer_.size();
    digest_.add(buffer_);
    buffer_.clear();
    return;
  }
  buffer_.clear();
  const bool cut = ::ftruncate(descriptor_, static_cast<off_t>(flushed_)) == 0 &&
                   ::lseek(descriptor_, static_cast<off_t>(flushed_), SEEK_SET) >= 0;
  if (!cut) give_up();  // the content of the file is not known to be complete
  fail(error);
}

void AtomicFile::replace_front(std::string_view bytes) {
  flush();
  if (bytes.size() > flushed_) throw std::logic_error("AtomicFile: a front longer than the file");
  const int error = ::lseek(descriptor_, 0, SEEK_SET) < 0 ? errno : write_all(descriptor_, bytes);
  if (error != 0 || ::lseek(descriptor_, static_cast<off_t>(flushed_), SEEK_SET) < 0) {
    const int cause = error != 0 ? error : errno;
    give_up();  // the content of the file is not known to be complete
    fail(cause);
  }
  digest_anew_ = digest_of_file(partial_path_);
}

void AtomicFile::checkpoint(records::Archive& archive) {
  if (!archive.is_reading()) {
    flush();
    if (const int error = sync_descriptor(descriptor_); error != 0) fail(error);
  }
  archive(flushed_, digest_);
  if (!archive.is_reading()) return;
  if (::ftruncate(descriptor_, static_cast<off_t>(std::min<std::uintmax_t>(
                                   flushed_, std::filesystem::file_size(partial_path_)))) != 0 ||
      ::lseek(descriptor_, static_cast<off_t>(flushed_), SEEK_SET) < 0)
    fail(errno);
  if (digest_of_file(partial_path_) != digest_.text())
    throw std::runtime_error(partial_path_.string() + " is not as it was at the checkpoint");
  digest_anew_.clear();
}

void AtomicFile::start_writing_out() {
  flush();
  (void)::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);  // errors are reported by the following fsync
}

void AtomicFile::commit(Durability durability) {
  if (durability == Durability::soon)
    start_writing_out();
  else
    flush();
  const bool is_waited_for = durability == Durability::now || durability == Durability::content;
  if (const int error = is_waited_for ? sync_descriptor(descriptor_) : 0; error != 0) {
    give_up();  // the system may have dropped the data after a failed write; a second fsync would not report this
    fail(error);
  }
  if (::rename(partial_path_.c_str(), final_path_.c_str()) != 0) fail(errno);
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0 && errno != EINTR) fail(errno);
  if (durability == Durability::now) sync_directory(final_path_.parent_path());
}

void write_file(const std::filesystem::path& path, std::string_view text, Durability durability) {
  AtomicFile file(path);
  file.write(text);
  file.commit(durability);
}

}  // namespace bough::io
