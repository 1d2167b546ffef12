#include "bough/io/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

#include "error_text.hpp"

namespace bough::io {
namespace {

/// Why a file cannot be opened, or examined.
std::string why_not(int error) {
  if (error == ENOENT) return "there is no such file";
  if (error == ELOOP) return "it is a link that leads to itself";
  return "the file can not be opened: " + error_text(error);
}

/// What a file is that is not a regular one; empty if it is one.
std::string other_kind(mode_t mode) {
  if (S_ISREG(mode)) return {};
  if (S_ISDIR(mode)) return "this is a directory, not a file";
  if (S_ISFIFO(mode)) return "this is a pipe, not a file; what a program prints is read with - in place of the name";
  return "this is a device or a socket, not a file";
}

}  // namespace

std::string too_large_text(std::uint64_t most_bytes) {
  return "the file is larger than " + std::to_string(most_bytes >> 20u) + " MB";
}

InputFile::InputFile(std::filesystem::path file, std::uint64_t most_bytes)
    : path_(std::move(file)), most_bytes_(most_bytes) {
  struct stat there = {};
  // Devices are not even opened: to open some of them has an effect.
  if (::stat(path_.c_str(), &there) != 0) throw Unreadable(path_, why_not(errno));
  if (const std::string kind = other_kind(there.st_mode); !kind.empty()) throw Unreadable(path_, kind);
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) throw Unreadable(path_, why_not(errno));
  std::string why = ::fstat(descriptor, &there) == 0 ? other_kind(there.st_mode) : why_not(errno);
  size_ = static_cast<std::uint64_t>(there.st_size);
  if (why.empty() && size_ > most_bytes) why = too_large_text(most_bytes);
  if (!why.empty()) {
    ::close(descriptor);
    throw Unreadable(path_, why);
  }
  descriptor_ = descriptor;
}

InputFile::~InputFile() { ::close(descriptor_); }

std::size_t InputFile::read(std::uint64_t offset, char* bytes, std::size_t count) const {
  if (offset > static_cast<std::uint64_t>(std::numeric_limits<off_t>::max()) - count) return 0;
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_, bytes + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Unreadable(path_, "the file can not be read to its end: " + error_text(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string InputFile::text(std::uint64_t offset) const {
  constexpr std::size_t piece = std::size_t{1} << 16u;
  std::string all;
  // A byte more than there are tells the end; a file that has grown is read on.
  for (auto wanted = static_cast<std::size_t>(size_ - std::min(offset, size_)) + 1;; wanted = piece) {
    const std::size_t before = all.size();
    all.resize(before + wanted);
    const std::size_t got = read(offset + before, all.data() + before, wanted);
    all.resize(before + got);
    if (all.size() > most_bytes_) throw Unreadable(path_, too_large_text(most_bytes_));
    if (got < wanted) return all;
  }
}

bool InputFile::next_line(std::string& line) {
  constexpr std::size_t piece = std::size_t{1} << 16u;
  line.clear();
  for (;;) {
    const std::size_t end = buffer_.find('\n', taken_);
    line.append(buffer_, taken_, std::min(end, buffer_.size()) - taken_);
    if (end != std::string::npos) {
      taken_ = end + 1;
      return has_line_end_ = true;
    }
    if (line.size() > max_line_bytes) throw Unreadable(path_, "a line is longer than any that bough writes");
    buffer_.resize(piece);
    buffer_.resize(read(next_offset_, buffer_.data(), piece));
    next_offset_ += buffer_.size();
    taken_ = 0;
    if (!buffer_.empty()) continue;
    if (!line.empty()) has_line_end_ = false;
    return !line.empty();
  }
}

std::string read_text(const std::filesystem::path& file, std::uint64_t most_bytes) {
  return InputFile(file, most_bytes).text();
}

}  // namespace bough::io
