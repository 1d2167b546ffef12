#include "checkpoint_file.hpp"

#include <stdexcept>
#include <vector>

#include "bough/io/columns.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/records/archive.hpp"

namespace bough::io {
namespace {

constexpr std::string_view checkpoint_format = "bough checkpoint 2";
constexpr std::size_t most_checkpoint_bytes = std::size_t{1} << 36u;

}  // namespace

CheckpointFile read_checkpoint_file(const std::filesystem::path& file) try {
  CheckpointFile found;
  const auto unusable = [&](const std::string& why) {
    found.fault = why;
    return found;
  };
  const std::string bytes = read_text(file, most_checkpoint_bytes);
  const std::size_t end = bytes.find('\n');
  std::vector<std::string> words;
  if (end == std::string::npos || !split_csv_line(std::string_view(bytes).substr(0, end), words) || words.size() != 7 ||
      !words[0].starts_with("bough checkpoint"))
    return unusable("it is not a checkpoint, or was cut off");
  if (words[0] != checkpoint_format) return unusable("it has the format of another version, \"" + words[0] + "\"");
  found.program_hash = words[1];
  found.identity = words[2];
  double number = 0.0, size = 0.0;
  if (!read_number(words[3], number) || !read_number(words[4], found.time) || !read_number(words[5], size))
    return unusable("its first line is damaged");
  found.number = whole_number<long>(number);
  const std::string_view rest = std::string_view(bytes).substr(end + 1);
  if (static_cast<double>(rest.size()) != size) return unusable("it was cut off");
  if (digest_of(rest) != words[6]) return unusable("it is damaged");
  records::Archive archive(rest);
  archive(found.state);
  found.files = archive.rest();
  return found;
} catch (const Unreadable& fault) {
  return {.fault = fault.why()};
} catch (const std::runtime_error& fault) {
  return {.fault = fault.what()};
}

std::string checkpoint_text(const CheckpointFile& checkpoint) {
  records::Archive archive;
  std::string state = checkpoint.state;
  archive(state);
  const std::string bytes = archive.bytes() + checkpoint.files;
  std::string head = std::string(checkpoint_format) + "," + checkpoint.program_hash + "," + checkpoint.identity + "," +
                     std::to_string(checkpoint.number) + ",";
  append_number(head, checkpoint.time);
  return head + "," + std::to_string(bytes.size()) + "," + digest_of(bytes) + "\n" + bytes;
}

}  // namespace bough::io
