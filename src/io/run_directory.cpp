#include "bough/io/run_directory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/unfinished_run.hpp"
#include "checkpoint_file.hpp"
#include "formats/result_format.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& all_names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names = {"summary.json", "checkpoint.*", "progress.json"};
    for (const ResultFormat& format : result_formats())
      names.insert(names.end(), format.files.begin(), format.files.end());
    return names;
  }();
  return all;
}

}  // namespace

RunDirectory::RunDirectory(fs::path directory, std::string version, RunOrigin origin, bool replaces,
                           CheckpointRule rule, std::vector<std::string> formats)
    : directory_(std::move(directory)),
      version_(std::move(version)),
      origin_(std::move(origin)),
      replaces_(replaces),
      wanted_(std::move(formats)),
      rule_(rule) {}

RunDirectory::~RunDirectory() = default;

void RunDirectory::make_writers() {
  writers_.clear();
  for (const ResultFormat& format : result_formats())
    if (format.name.empty() || std::find(wanted_.begin(), wanted_.end(), format.name) != wanted_.end())
      writers_.push_back(format.make(folder_->staging()));
}

void RunDirectory::find_checkpoints() {
  const Owner owner{"run", origin_.scene_file, origin_.key, replaces_};
  for (const fs::path& place : OutputFolder::unfinished_in(directory_, owner))
    if (found_.empty()) found_ = checkpoints_in(place);
}

bool RunDirectory::has_all() {
  find_checkpoints();
  const bool can_go_on = !found_.empty();
  told_.clear();  // `open` tells it
  found_.clear();
  const Owner owner{"run", origin_.scene_file, origin_.key, replaces_};
  const std::optional<Manifest> manifest = read_manifest(directory_);
  if (can_go_on || !manifest || manifest->state != FolderState::good || is_of_another(directory_, owner)) return false;
  std::vector<std::string> names;
  for (const ResultFormat& format : result_formats())
    for (const std::string& name : format.files)
      if (name.back() != '*') names.push_back(name);
  try {
    const SummaryFile summary = read_unchanged(directory_, [&] { return read_whole_summary(directory_, names); });
    return summary.status == status_text(records::RunStatus::ok) && summary.scene_hash == origin_.scene_hash &&
           summary.overrides == origin_.overrides && summary.start_hash == (origin_.from ? origin_.from->hash : "");
  } catch (const std::runtime_error&) {
    return false;
  }
}

void RunDirectory::open() {
  if (folder_) return;
  const Owner owner{"run", origin_.scene_file, origin_.key, replaces_};
  if (rule_.resumes) find_checkpoints();
  folder_ = std::make_unique<OutputFolder>(directory_, owner, all_names(), origin_.inputs(),
                                           found_.empty() ? fs::path() : found_.back().place);
  if (!found_.empty())
    told_.push_back("going on from time " + rounded_text(found_.back().time, 6));
  else if (rule_.resumes)
    told_.push_back("there is no checkpoint to go on from: the run begins");
  if (!folder_->kept_of_killed().empty())
    told_.push_back("what a run that was killed had recorded stands in " + folder_->kept_of_killed().string() +
                    (rule_.resumes ? "" : ", and --resume goes on from its last checkpoint"));
}

/// A checkpoint belongs to a scene with all that was changed in it and the state from which it started, or to a case,
/// and to a program.
std::string RunDirectory::identity() const {
  std::string what = origin_.key.empty() ? origin_.scene_hash : origin_.key;
  for (const std::string& text : origin_.overrides) what += "\n" + text;
  if (origin_.from) what += "\nfrom " + origin_.from->hash;
  return digest_of(what);
}

std::vector<RunDirectory::Checkpoint> RunDirectory::checkpoints_in(const fs::path& place) {
  std::vector<Checkpoint> good;
  for (const char* name : {"checkpoint.1", "checkpoint.2"}) {
    if (!fs::exists(fs::symlink_status(place / name))) continue;
    if (std::optional<Checkpoint> one = read_checkpoint(place / name)) good.push_back(std::move(*one));
  }
  if (good.size() == 2 && good[0].number > good[1].number) std::swap(good[0], good[1]);
  return good;
}

std::optional<RunDirectory::Checkpoint> RunDirectory::read_checkpoint(const fs::path& file) {
  CheckpointFile found = read_checkpoint_file(file);
  if (found.fault.empty() && found.head.program_hash != origin_.program_hash)
    found.fault = "another program has written it";
  else if (found.fault.empty() && found.head.identity != identity())
    found.fault = "it is of another scene, or of other values of --set or --from";
  if (found.fault.empty())
    return Checkpoint{file.parent_path(),       found.head.number,      found.head.time,
                      file.filename().string(), std::move(found.state), std::move(found.files)};
  told_.push_back(file.string() + " cannot be used: " + found.fault);
  return std::nullopt;
}

void RunDirectory::note_progress(const records::Progress& progress) {
  constexpr auto interval = std::chrono::seconds(2);
  const auto now = std::chrono::steady_clock::now();
  if (now - told_at_ < interval || !folder_) return;
  told_at_ = now;
  const std::chrono::duration<double> seconds = now - begun_at_;
  write_file(folder_->staging() / "progress.json",
             progress_text({progress.time, progress.end_time, progress.step, seconds.count(),
                            found_.empty() ? 0.0 : found_.back().time}),
             Durability::later);
}

bool RunDirectory::is_checkpoint_due(double time, bool is_last) {
  time_ = time;
  if (!keeps_checkpoints()) return false;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - kept_at_;
  return is_last || since.count() >= rule_.wall_clock ||
         (rule_.time > 0.0 && std::abs(time - kept_time_) >= rule_.time);
}

void RunDirectory::checkpoint(std::string_view state) {
  records::Archive archive;
  for (const auto& writer : writers_) writer->checkpoint(archive, {});
  ++num_checkpoints_;
  write_checkpoint_file(folder_->staging() / (num_checkpoints_ % 2 == 1 ? "checkpoint.1" : "checkpoint.2"),
                        {{}, origin_.program_hash, identity(), num_checkpoints_, time_, 0, {}}, state, archive.bytes());
  kept_at_ = std::chrono::steady_clock::now();
  kept_time_ = time_;
}

std::string RunDirectory::resume(const records::HistoryHeader& header) {
  open();
  if (found_.empty()) return {};
  for (;;) {
    const Checkpoint& from = found_.back();
    try {
      records::Archive archive(from.files);
      make_writers();
      for (const auto& writer : writers_) writer->checkpoint(archive, header);
      archive.require_end();
      break;
    } catch (const std::runtime_error& fault) {
      writers_.clear();  // the files stay as they are
      if (found_.size() == 1) throw;
      told_.push_back((from.place / from.name).string() + " cannot be used: " + fault.what());
      found_.pop_back();
      told_.push_back("going on from time " + rounded_text(found_.back().time, 6));
    }
  }
  fs::remove(folder_->staging() / "summary.json");  // of the part before; the run has not ended now
  num_checkpoints_ = found_.back().number;
  kept_time_ = found_.back().time;
  return std::move(found_.back().state);
}

/// Checkpoints stay with results that a run can go on from; others have no use for them.
void RunDirectory::settle_checkpoints(records::RunStatus status) {
  can_go_on_ = false;
  for (const char* name : {"checkpoint.1", "checkpoint.2"}) {
    const fs::path file = folder_->staging() / name;
    if (!fs::exists(fs::symlink_status(file))) continue;
    const bool stays = status != records::RunStatus::ok && (status == records::RunStatus::interrupted || was_cut_off_);
    can_go_on_ = can_go_on_ || stays;
    if (stays)
      folder_->add({name, fs::file_size(file), digest_of_file(file)});
    else
      fs::remove(file);
  }
}

void RunDirectory::begin(const records::HistoryHeader& header) {
  open();
  make_writers();
  try {
    for (const auto& writer : writers_) writer->begin(header);
  } catch (...) {
    writers_.clear();  // it has not begun
    throw;
  }
}

void RunDirectory::row(const records::HistoryRow& row) {
  if (!has_begun()) throw std::logic_error("RunDirectory: a row before begin");
  for (const auto& writer : writers_) writer->row(row);
}

void RunDirectory::motion(const records::MotionFrame& frame) {
  for (const auto& writer : writers_) writer->motion(frame, parts_);
}

void RunDirectory::state(const records::StoredState& state) {
  for (const auto& writer : writers_) writer->state(state);
}

std::exception_ptr RunDirectory::commit_files(const records::Summary& summary) {
  std::exception_ptr failure;
  const auto list = [this](FileRecord record) {
    folder_->add(record);
    records_.push_back(std::move(record));
  };
  for (const auto& writer : writers_) {
    try {
      for (std::string& name : writer->commit(summary, list)) files_.push_back(std::move(name));
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  return failure;
}

void RunDirectory::end(const records::Summary& summary) {
  if (!has_begun()) begin(summary.header);
  has_ended_ = true;
  std::exception_ptr failure = commit_files(summary);
  if (!failure) {  // otherwise there is no summary, since the directory is incomplete
    try {
      folder_->write_index("summary.json", summary_text(summary, version_, origin_, records_));
      files_.emplace_back("summary.json");
    } catch (...) {
      failure = std::current_exception();
    }
  }
  std::error_code ignored;
  fs::remove(folder_->staging() / "progress.json", ignored);
  const bool is_good = !failure && summary.status == records::RunStatus::ok;
  was_cut_off_ = was_cut_off_ || failure;
  try {
    settle_checkpoints(is_good ? records::RunStatus::ok : summary.status);
    folder_->publish(is_good ? FolderState::good : FolderState::failed);
  } catch (...) {
    if (!failure) failure = std::current_exception();
  }
  if (failure) std::rethrow_exception(failure);
}

std::optional<fs::path> RunDirectory::keep_rows_of_killed(const fs::path& directory, const Owner& owner) {
  const fs::path kept = OutputFolder::keep_of_killed(directory, owner);
  return kept.empty() ? std::nullopt : std::optional(kept);
}

fs::path RunDirectory::keep_rows(const fs::path& directory, const Owner& owner, std::string_view rows) {
  OutputFolder folder(directory, owner, all_names());
  folder.write("history.csv", rows);
  folder.publish(FolderState::failed);
  return folder.folder();
}

void RunDirectory::end_as_failed(records::Summary summary, const std::string& cause) {
  if (!has_begun() || has_ended()) return;
  summary.status = records::RunStatus::failed;
  summary.cause = cause;
  was_cut_off_ = true;
  end(summary);
}

}  // namespace bough::io
