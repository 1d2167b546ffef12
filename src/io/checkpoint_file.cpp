#include "checkpoint_file.hpp"

#include <cstdint>
#include <optional>
#include <stdexcept>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
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
  const std::optional<CheckpointHead> head =
      end == std::string::npos ? std::nullopt : read_checkpoint_head(std::string_view(bytes).substr(0, end));
  if (!head || !head->format.starts_with("bough checkpoint"))
    return unusable("it is not a checkpoint, or was cut off, or its first line is damaged");
  if (head->format != checkpoint_format)
    return unusable("it has the format of another version, \"" + head->format + "\"");
  found.head = *head;
  const std::string_view rest = std::string_view(bytes).substr(end + 1);
  if (rest.size() != head->num_bytes) return unusable("it was cut off");
  if (digest_of(rest) != head->digest) return unusable("it is damaged");
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

void write_checkpoint_file(const std::filesystem::path& path, CheckpointHead head, std::string_view state,
                           std::string_view files) {
  const auto length = static_cast<std::uint64_t>(state.size());  // as an archive has it before a string
  const std::string_view parts[] = {{reinterpret_cast<const char*>(&length), sizeof length}, state, files};
  Digest digest;
  for (const std::string_view part : parts) digest.add(part);
  head.format = checkpoint_format;
  head.num_bytes = digest.num_bytes();
  head.digest = digest.text();
  AtomicFile file(path);
  file.write(head.text());
  for (const std::string_view part : parts) file.write(part);
  file.commit();
}

}  // namespace bough::io
