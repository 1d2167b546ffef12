#include "bough/io/unfinished_run.hpp"

#include <algorithm>

#include "bough/io/folder_lock.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/read_scene.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

double number_in(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr && value->is(JsonKind::number) ? value->number : 0.0;
}

std::optional<RunProgress> read_progress(const fs::path& file) try {
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> json = parse_json(read_text(file, max_file_bytes), source_file, faults);
  if (!json || !faults.empty() || !json->is(JsonKind::object)) return std::nullopt;
  return RunProgress{number_in(*json, "time"), number_in(*json, "end_time"),
                     whole_number<long>(number_in(*json, "steps")), number_in(*json, "seconds"),
                     number_in(*json, "from")};
} catch (const Unreadable&) {
  return std::nullopt;
}

/// Of the later one of two checkpoints, by the line at its head.
std::optional<double> last_checkpoint_time(const fs::path& place) {
  std::optional<double> time;
  long last = 0;
  for (const char* name : {"checkpoint.1", "checkpoint.2"}) try {
      InputFile file(place / name);
      std::string line;
      const std::optional<CheckpointHead> head = file.next_line(line) ? read_checkpoint_head(line) : std::nullopt;
      if (!head || head->number < last) continue;
      last = head->number;
      time = head->time;
    } catch (const Unreadable&) {
    }
  return time;
}

}  // namespace

std::string CheckpointHead::text() const {
  std::string line = format + "," + program_hash + "," + identity + "," + std::to_string(number) + ",";
  append_number(line, time);
  return line + "," + std::to_string(num_bytes) + "," + digest + "\n";
}

std::optional<CheckpointHead> read_checkpoint_head(std::string_view line) {
  std::vector<std::string> words;
  CheckpointHead head;
  double number = 0.0, size = 0.0;
  if (!split_csv_line(line, words) || words.size() != 7 || !read_number(words[3], number) ||
      !read_number(words[4], head.time) || !read_number(words[5], size))
    return std::nullopt;
  head.format = words[0];
  head.program_hash = words[1];
  head.identity = words[2];
  head.number = whole_number<long>(number);
  head.num_bytes = whole_number<std::uint64_t>(size);
  head.digest = words[6];
  return head;
}

std::string progress_text(const RunProgress& progress) {
  JsonText json;
  json.begin_object();
  json.member("time", progress.time);
  json.member("end_time", progress.end_time);
  json.member("steps", static_cast<long long>(progress.steps));
  json.member("seconds", progress.seconds);
  json.member("from", progress.from);
  json.end_object();
  return json.text();
}

std::optional<UnfinishedRun> find_unfinished_run(const fs::path& directory) {
  std::error_code ignored;
  for (const fs::path& place : {directory, OutputFolder::staging_of(directory)}) {
    const std::optional<Manifest> manifest = read_manifest(place);
    if (!manifest) continue;
    if (manifest->made_by != "run" || fs::exists(fs::symlink_status(place / "summary.json", ignored)))
      return std::nullopt;
    UnfinishedRun run{place};
    if (file_so_far(run, "history.csv").empty()) return std::nullopt;
    run.goes_on = !FolderLock().take(place);
    run.progress = read_progress(place / "progress.json");
    run.checkpoint = last_checkpoint_time(place);
    return run;
  }
  return std::nullopt;
}

fs::path file_so_far(const UnfinishedRun& run, const std::string& name) {
  std::error_code ignored;
  for (const std::string& named : {name, name + ".partial"})
    if (fs::is_regular_file(fs::symlink_status(run.place / named, ignored))) return run.place / named;
  return {};
}

History read_rows_so_far(const UnfinishedRun& run) { return read_history(file_so_far(run, "history.csv"), true); }

}  // namespace bough::io
