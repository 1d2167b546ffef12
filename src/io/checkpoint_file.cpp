#include "checkpoint_file.hpp"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/history.hpp"
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
  found.head.program_hash = words[1];
  found.head.identity = words[2];
  double number = 0.0, size = 0.0;
  if (!read_number(words[3], number) || !read_number(words[4], found.head.time) || !read_number(words[5], size))
    return unusable("its first line is damaged");
  found.head.number = whole_number<long>(number);
  const std::string_view rest = std::string_view(bytes).substr(end + 1);
  if (static_cast<double>(rest.size()) != size) return unusable("it was cut off");
  if (digest_of(rest) != words[6]) return unusable("it is damaged");
  records::Archive archive(rest);
  archive(found.state);
  found.files = archive.rest();
  return found;
} catch (const Unreadable& fault) {
  CheckpointFile none;
  none.fault = fault.why();
  return none;
} catch (const std::runtime_error& fault) {
  CheckpointFile none;
  none.fault = fault.what();
  return none;
}

void write_checkpoint_file(const std::filesystem::path& path, const CheckpointHead& head, std::string_view state,
                           std::string_view files) {
  const auto length = static_cast<std::uint64_t>(state.size());  // as an archive has it before a string
  const std::string_view parts[] = {{reinterpret_cast<const char*>(&length), sizeof length}, state, files};
  Digest digest;
  std::size_t bytes = 0;
  for (const std::string_view part : parts) {
    digest.add(part);
    bytes += part.size();
  }
  std::string line = std::string(checkpoint_format) + "," + head.program_hash + "," + head.identity + "," +
                     std::to_string(head.number) + ",";
  append_number(line, head.time);
  AtomicFile file(path);
  file.write(line + "," + std::to_string(bytes) + "," + digest.text() + "\n");
  for (const std::string_view part : parts) file.write(part);
  file.commit();
}

}  // namespace bough::io
