#pragma once
/// Text that outlives the process which wrote it.
#include <cstddef>
#include <string_view>

namespace bough::io {

/// Memory that a process shares with those which it forks: what one of them has appended is there for the others when
/// it has died, by whatever signal. One process writes at a time. Pages are taken from the machine as text grows; it
/// is no data segment of any process (RLIMIT_DATA).
class SharedText {
 public:
  /// capacity [bytes]. Where the system refuses the memory nothing is ever kept.
  explicit SharedText(std::size_t capacity);
  ~SharedText();
  SharedText(SharedText&& other) noexcept { *this = static_cast<SharedText&&>(other); }
  SharedText& operator=(SharedText&& other) noexcept;

  void clear();
  /// All of it or nothing, so that the text ends where one of these pieces does. False where there is no room.
  bool append(std::string_view piece);
  [[nodiscard]] std::string_view text() const;

 private:
  struct Shared;
  Shared* shared_ = nullptr;
  std::size_t bytes_ = 0;  ///< of the mapping
};

}  // namespace bough::io
