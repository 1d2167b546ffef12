#pragma once
/// The three standard streams of the process: always open, fit for a terminal, and told of where they cannot be
/// written.
#include <memory>
#include <streambuf>
#include <string_view>

namespace bough::app {

/// Puts something in the place of standard streams that are closed, which can neither be read nor written, so that no
/// file ever gets their numbers. To be called before anything is opened.
void hold_standard_descriptors();

/// A pipe that nobody reads any more and a file that may not grow are errors of the write that meets them, which then
/// says so, and do not end the process.
void ignore_signals_of_writes();

/// While it lives, std::cout and std::cerr write printable text only (io::append_printable): names and messages come
/// from files.
class StandardStreams {
 public:
  StandardStreams();
  ~StandardStreams();
  StandardStreams(const StandardStreams&) = delete;
  StandardStreams& operator=(const StandardStreams&) = delete;

  /// Writes out what is left. Returns `code`, or `exit_failed` with a message where standard output could not take
  /// all that was written.
  [[nodiscard]] int finish(int code);

  class Printable;  ///< the buffer of a stream

 private:
  std::unique_ptr<Printable> output_, errors_;
  std::streambuf *former_output_, *former_errors_;
};

/// The control sequences of a terminal that the program itself writes: to the start of the line, and away with what
/// stands behind it.
inline constexpr std::string_view line_start = "\r", line_rest_erased = "\x1b[K";

/// Lets pass what the program itself wants a terminal to do: `line_start`, `line_rest_erased`, and colours (ESC [
/// digits m), in `text` whose other parts are printable. Standard error where `to_errors`, standard output else.
void write_to_terminal(bool to_errors, std::string_view text);

}  // namespace bough::app
