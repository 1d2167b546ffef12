#include "bough/io/run_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "bough/io/columns.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/history.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/output_folder.hpp"
#include "result_tables.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view record_begin = "bough run ";
constexpr std::size_t max_head = 4096;  // [bytes] of the line before the files

[[noreturn]] void fail(const fs::path& file, int error) {
  throw std::runtime_error("cannot write " + file.string() + ": " + std::generic_category().message(error));
}

std::string store_name(int number) {
  std::string digits = std::to_string(number);
  return "store_" + digits.insert(0, digits.size() < 3 ? 3 - digits.size() : 0, '0') + ".pack";
}

bool is_store(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("store_") && name.ends_with(".pack");
}

std::string head_of(const std::vector<StoredFile>& files, const std::string& key) {
  std::string head = std::string(record_begin) + "[" + json_string(key);
  for (const StoredFile& file : files)
    head +=
        ",[" + json_string(file.name) + "," + std::to_string(file.text.size()) + ",\"" + digest_of(file.text) + "\"]";
  return head + "]\n";
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

RunStore::RunStore(const fs::path& folder) {
  constexpr int most = 10000;
  for (int number = 0; number < most; ++number) {
    file_ = folder / store_name(number);
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(file_, errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
  }
  descriptor_ = -1;
  throw std::runtime_error("all stores of " + folder.string() + " are in use");
}

RunStore::~RunStore() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

StoredPlace RunStore::add(const std::vector<StoredFile>& files, const std::string& key) {
  const off_t offset = ::lseek(descriptor_, 0, SEEK_END);
  if (offset < 0) fail(file_, errno);
  std::string record = head_of(files, key);
  for (const StoredFile& file : files) record += file.text;
  record += '\n';
  if (!write_all(descriptor_, record)) {
    const int error = errno;
    if (::ftruncate(descriptor_, offset) != 0) ::close(std::exchange(descriptor_, -1));
    fail(file_, error);
  }
  return {file_.filename().string(), static_cast<std::uint64_t>(offset)};
}

std::optional<std::vector<StoredFile>> read_stored(const fs::path& folder, const StoredPlace& place,
                                                   const std::string& key) try {
  const InputFile in(folder / fs::path(place.store).filename());
  std::string head(max_head, '\0');
  head.resize(in.read(place.offset, head.data(), head.size()));
  const std::size_t end = head.find('\n');
  if (end == std::string::npos || !head.starts_with(record_begin)) return std::nullopt;
  head.resize(end);
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> list =
      parse_json(std::string_view(head).substr(record_begin.size()), source_file, faults);
  if (!list || !faults.empty() || !list->is(JsonKind::array) || list->items.size() == 0 ||
      list->items[0].text.str() != key)
    return std::nullopt;
  std::uint64_t offset = place.offset + end + 1;
  std::vector<StoredFile> files;
  for (std::size_t k = 1; k < list->items.size(); ++k) {
    const JsonValue& item = list->items[k];
    if (!item.is(JsonKind::array) || item.items.size() != 3 || !item.items[0].is(JsonKind::string) ||
        !item.items[1].is(JsonKind::number) || !item.items[2].is(JsonKind::string))
      return std::nullopt;
    const double bytes = item.items[1].number;
    if (!(bytes >= 0.0 && bytes <= static_cast<double>(in.size()))) return std::nullopt;
    std::string text(static_cast<std::size_t>(bytes), '\0');
    if (in.read(offset, text.data(), text.size()) < text.size() || digest_of(text) != item.items[2].text.str())
      return std::nullopt;
    offset += text.size();
    files.push_back({item.items[0].text.str(), std::move(text)});
  }
  return files;
} catch (const Unreadable&) {
  return std::nullopt;
}

void sync_stores(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (is_store(entry.path())) sync_file(entry.path());
  sync_directory(folder);
}

fs::path unpack_run(const std::vector<StoredFile>& files, FolderState state, const fs::path& folder,
                    const Owner& owner) {
  std::vector<std::string> names;
  for (const StoredFile& file : files) {
    names.push_back(fs::path(file.name).filename().string());
    if (names.back() != file.name || file.name.empty() || file.name.front() == '.')
      throw std::runtime_error("a stored file is called " + file.name);
  }
  OutputFolder output(folder, owner, names);
  for (const StoredFile& file : files) {
    if (file.name == "summary.json")
      output.write_index(file.name, file.text);
    else
      output.write(file.name, file.text);
  }
  output.publish(state);
  return output.folder();
}

void RunInMemory::begin(const records::HistoryHeader& header) {
  history_ = history_head(header);
  if (twin_ != nullptr) {
    twin_->clear();
    keep_twin(0);
  }
  columns_ = columns_text(header);
}

void RunInMemory::row(const records::HistoryRow& row) {
  const std::size_t begin = history_.size();
  append_history_row(history_, row);
  keep_twin(begin);
}

void RunInMemory::keep_twin(std::size_t begin) {
  if (twin_ != nullptr && !twin_->append(std::string_view(history_).substr(begin))) twin_ = nullptr;  // without gaps
}

void RunInMemory::motion(const records::MotionFrame& frame) { motion_bytes_.append(motion_, frame); }

void RunInMemory::end(const records::Summary& summary) {
  if (history_.empty()) begin(summary.header);
  files_.push_back({"history.csv", std::move(history_)});
  files_.push_back({"columns.json", std::move(columns_)});
  if (!motion_.empty()) files_.push_back({"motion.bin", std::move(motion_)});
  for (const records::Table& table : summary.tables) files_.push_back({file_of(table), table_csv(table)});
  std::vector<FileRecord> records;
  for (const StoredFile& file : files_) records.push_back({file.name, file.text.size(), digest_of(file.text)});
  files_.push_back({"summary.json", summary_text(summary, version_, origin_, records)});
}

void RunInMemory::end_as_failed(records::Summary summary, const std::string& cause) {
  if (!files_.empty()) return;
  summary.status = records::RunStatus::failed;
  summary.cause = cause;
  end(summary);
}

}  // namespace bough::io
