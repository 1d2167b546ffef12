#include "standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <iostream>
#include <streambuf>
#include <system_error>

#include "arguments.hpp"
#include "bough/io/printable_text.hpp"

namespace bough::app {

void hold_standard_descriptors() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is this one. Opened the wrong way round: who reads or writes here is told so.
    const int direction = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    int held = ::open("/dev/null", direction);
    if (held < 0) held = ::open("/", O_RDONLY | O_DIRECTORY);
    if (held != descriptor) ::_exit(exit_failed);  // there is nowhere to say why
  }
}

void ignore_signals_of_writes() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// A buffer before a descriptor that escapes what a terminal would act on.
class StandardStreams::Printable final : public std::streambuf {
 public:
  /// Takes all the memory that it will need, so that also a process that has no more of it can write.
  explicit Printable(int descriptor) : descriptor_(descriptor), is_terminal_(::isatty(descriptor) != 0) {
    constexpr std::size_t longest_escape = 8, longest_character = 4;
    buffer_.reserve(flush_at + longest_escape * (longest_piece + longest_character));
    incomplete_.reserve(longest_piece + longest_character);
  }

  int error() const { return error_; }  ///< errno of the first write that failed; 0: none did

  /// As it is, behind what was written before.
  void write_raw(std::string_view bytes) {
    sync();
    buffer_ += bytes;
    sync();
  }
  /// What is left, a cut character included.
  void finish() {
    for (const char& byte : incomplete_) io::append_printable(buffer_, {&byte, 1}, 0);
    incomplete_.clear();
    sync();
  }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    for (std::string_view left(bytes, static_cast<std::size_t>(count)); !left.empty();) {
      const std::string_view piece = left.substr(0, longest_piece);
      append(piece);
      left.remove_prefix(piece.size());
      if (buffer_.size() >= flush_at && sync() != 0) return 0;
    }
    const bool wants_out = is_terminal_ && buffer_.find('\n') != std::string::npos;
    return wants_out && sync() != 0 ? 0 : count;
  }
  int_type overflow(int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    const char byte = traits_type::to_char_type(character);
    return xsputn(&byte, 1) == 1 ? character : traits_type::eof();
  }
  int sync() override {
    std::string_view bytes = buffer_;
    while (error_ == 0 && !bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0)
        error_ = written < 0 ? errno : EIO;
      else
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    buffer_.clear();
    return error_ == 0 ? 0 : -1;
  }

 private:
  static constexpr std::size_t longest_piece = 1024, flush_at = 1u << 14u;

  /// Bytes that begin a character whose rest has not come yet wait for it in `incomplete_`.
  void append(std::string_view piece) {
    constexpr std::size_t longest_character = 4;
    incomplete_.append(piece);
    std::string_view text = incomplete_;
    while (!text.empty()) {
      const std::size_t length = io::utf8_length(text);
      const bool may_be_cut =
          length == 0 && text.size() < longest_character && static_cast<unsigned char>(text[0]) >= 0xC2;
      if (may_be_cut) break;
      io::append_printable(buffer_, text, length);
      text.remove_prefix(length == 0 ? 1 : length);
    }
    incomplete_.erase(0, incomplete_.size() - text.size());
  }

  int descriptor_;
  bool is_terminal_;
  int error_ = 0;
  std::string buffer_, incomplete_;
};

StandardStreams::StandardStreams()
    : output_(std::make_unique<Printable>(STDOUT_FILENO)),
      errors_(std::make_unique<Printable>(STDERR_FILENO)),
      former_output_(std::cout.rdbuf(output_.get())),
      former_errors_(std::cerr.rdbuf(errors_.get())) {}

StandardStreams::~StandardStreams() {
  std::cout.rdbuf(former_output_);
  std::cerr.rdbuf(former_errors_);
}

int StandardStreams::finish(int code) {
  output_->finish();
  if (output_->error() != 0) {
    std::cerr << "bough: cannot write to standard output: "
              << std::error_code(output_->error(), std::generic_category()).message() << "\n";
    if (code == exit_done) code = exit_failed;
  }
  errors_->finish();
  return code;
}

namespace {

/// Length of a colour (ESC [ digits and semicolons m) or of one of the other sequences at the start of `text`; 0:
/// there is none.
std::size_t control_length(std::string_view text) {
  for (const std::string_view known : {line_start, line_rest_erased})
    if (text.starts_with(known)) return known.size();
  if (!text.starts_with("\x1b[")) return 0;
  const std::size_t end = text.find_first_not_of("0123456789;", 2);
  return end != std::string_view::npos && text[end] == 'm' ? end + 1 : 0;
}

}  // namespace

void write_to_terminal(bool to_errors, std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    const std::size_t control = control_length(text);
    const std::size_t length = control > 0 ? control : io::utf8_length(text);
    if (control > 0)
      safe += text.substr(0, control);
    else
      io::append_printable(safe, text, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  std::ostream& stream = to_errors ? std::cerr : std::cout;
  stream.flush();
  if (auto* buffer = dynamic_cast<StandardStreams::Printable*>(stream.rdbuf()))
    buffer->write_raw(safe);
  else
    stream << safe << std::flush;
}

}  // namespace bough::app
