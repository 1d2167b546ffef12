#include "bough/io/run_directory.hpp"

#include <cmath>
#include <stdexcept>
#include <system_error>

#include "bough/io/columns.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/unfinished_run.hpp"
#include "checkpoint_file.hpp"
#include "linear_model_files.hpp"
#include "measured_errors.hpp"
#include "result_tables.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

#ifdef BOUGH_HAS_VTK
constexpr bool has_vtk = true;
#else
constexpr bool has_vtk = false;  // the code below it is not compiled, since vtu_text is not available
#endif

const std::vector<std::string> all_names = [] {
  std::vector<std::string> names = {"history.csv",  "history.npy",  "columns.json",   "errors.csv",
                                    "motion.bin",   "motion.pvd",   "motion/frame_*", "states.bin",
                                    "summary.json", "checkpoint.*", "progress.json"};
  for (const auto* list : {&table_files, &linear_model_names}) names.insert(names.end(), list->begin(), list->end());
  return names;
}();

std::string frame_name(std::size_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return "motion/frame_" + digits + ".vtu";
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw std::runtime_error("cannot make the directory " + path.string() + ": " + error.message());
}

}  // namespace

RunDirectory::RunDirectory(fs::path directory, std::string version, RunOrigin origin, bool replaces,
                           CheckpointRule rule)
    : directory_(std::move(directory)),
      version_(std::move(version)),
      origin_(std::move(origin)),
      replaces_(replaces),
      rule_(rule) {}

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
  try {
    const SummaryFile summary = read_unchanged(directory_, [&] {
      return read_whole_summary(directory_, {"history.csv", "history.npy", "columns.json", "motion.bin", "states.bin"});
    });
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
  folder_ = std::make_unique<OutputFolder>(directory_, owner, all_names, origin_.inputs(),
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
  for (; synced_frames_ < frame_records_.size(); ++synced_frames_)
    sync_file(folder_->staging() / frame_records_[synced_frames_].name);
  take_files(archive, {});
  ++num_checkpoints_;
  write_checkpoint_file(folder_->staging() / (num_checkpoints_ % 2 == 1 ? "checkpoint.1" : "checkpoint.2"),
                        {{}, origin_.program_hash, identity(), num_checkpoints_, time_, 0, {}}, state, archive.bytes());
  kept_at_ = std::chrono::steady_clock::now();
  kept_time_ = time_;
}

/// Positions in all files; where they are read, the files are cut back to these and gone on with.
void RunDirectory::take_files(records::Archive& archive, const records::HistoryHeader& header) {
  const fs::path& staging = folder_->staging();
  bool has_motion = motion_ != nullptr;
  archive(has_motion, frames_, frame_records_);
  if (archive.is_reading()) {
    for (const FileRecord& frame : frame_records_)
      if (digest_of_file(staging / frame.name) != frame.hash)
        throw std::runtime_error((staging / frame.name).string() + " is not as it was at the checkpoint");
    history_ = std::make_unique<HistoryWriter>(staging / "history.csv", header, archive);
    twin_ = std::make_unique<NpyHistoryWriter>(staging / "history.npy", header);
    states_ = std::make_unique<StateWriter>(staging / "states.bin");
    if (has_motion) motion_ = std::make_unique<MotionWriter>(staging / "motion.bin", archive);
  } else {
    archive(*history_);
    if (has_motion) archive(*motion_);
  }
  archive(*twin_, *states_);
}

/// The files stay as they are.
void RunDirectory::forget_files() {
  history_.reset();
  twin_.reset();
  states_.reset();
  motion_.reset();
  frames_.clear();
  frame_records_.clear();
}

std::string RunDirectory::resume(const records::HistoryHeader& header) {
  open();
  if (found_.empty()) return {};
  for (;;) {
    const Checkpoint& from = found_.back();
    try {
      records::Archive archive(from.files);
      take_files(archive, header);
      archive.require_end();
      break;
    } catch (const std::runtime_error& fault) {
      forget_files();
      if (found_.size() == 1) throw;
      told_.push_back((from.place / from.name).string() + " cannot be used: " + fault.what());
      found_.pop_back();
      told_.push_back("going on from time " + rounded_text(found_.back().time, 6));
    }
  }
  fs::remove(folder_->staging() / "summary.json");  // of the part before; the run has not ended now
  columns_ = columns_text(header);
  num_checkpoints_ = found_.back().number;
  kept_time_ = found_.back().time;
  synced_frames_ = frame_records_.size();
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
  history_ = std::make_unique<HistoryWriter>(folder_->staging() / "history.csv", header);
  twin_ = std::make_unique<NpyHistoryWriter>(folder_->staging() / "history.npy", header);
  states_ = std::make_unique<StateWriter>(folder_->staging() / "states.bin");
  columns_ = columns_text(header);
  write_file(folder_->staging() / "columns.json", columns_, Durability::later);  // for readers while the run goes on
}

void RunDirectory::row(const records::HistoryRow& row) {
  if (!history_) throw std::logic_error("RunDirectory: a row before begin");
  history_->row(row);
  twin_->row(row);
}

void RunDirectory::motion(const records::MotionFrame& frame) {
  if (!motion_) {
    if constexpr (has_vtk) make_directory(folder_->staging() / "motion");
    motion_ = std::make_unique<MotionWriter>(folder_->staging() / "motion.bin", parts_);
  }
  if constexpr (has_vtk) {
    if (frame.for_others) {
      const std::string name = frame_name(frames_.size());
      const std::string text = vtu_text(frame, parts_);
      write_file(folder_->staging() / name, text, Durability::soon);
      frames_.push_back({frame.time, name});
      frame_records_.push_back({name, text.size(), digest_of(text)});
    }
  }
  motion_->frame(frame);
}

void RunDirectory::state(const records::StoredState& state) { states_->state(state); }

void RunDirectory::list(FileRecord record) {
  folder_->add(record);
  records_.push_back(std::move(record));
}

std::exception_ptr RunDirectory::commit_files() {
  std::exception_ptr failure;
  const auto attempt = [&](const char* name, const auto& write) {
    try {
      write();
      files_.emplace_back(name);
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  };
  const auto commit = [this](auto& writer) {
    try {
      writer.commit(Durability::soon);
    } catch (const std::exception&) {
      // The rows since the last flush are lost. Those before it are complete, and the file may still be committed.
      if (!writer.can_commit()) throw;
      writer.commit(Durability::soon);
      list(writer.record());
      throw;
    }
    list(writer.record());
  };
  attempt("history.csv", [&] { commit(*history_); });
  if (twin_->has_begun()) attempt("history.npy", [&] { commit(*twin_); });
  attempt("columns.json", [&] {
    // Listed in any case: the same text has stood there since the run began.
    list({"columns.json", columns_.size(), digest_of(columns_)});
    write_file(folder_->staging() / "columns.json", columns_, Durability::soon);
  });
  if (motion_) attempt("motion.bin", [&] { commit(*motion_); });
  if (states_->has_begun()) attempt("states.bin", [&] { commit(*states_); });
  if constexpr (has_vtk) {
    if (motion_) {
      attempt("motion", [&] {
        for (const FileRecord& frame : frame_records_) list(frame);
      });
      attempt("motion.pvd", [&] {
        const std::string text = pvd_text(frames_);
        write_file(folder_->staging() / "motion.pvd", text, Durability::soon);
        list({"motion.pvd", text.size(), digest_of(text)});
      });
    }
  }
  return failure;
}

std::exception_ptr RunDirectory::commit_text(const std::string& name, const std::string& text) {
  try {
    write_file(folder_->staging() / name, text, Durability::soon);
    list({name, text.size(), digest_of(text)});
    files_.push_back(name);
  } catch (...) {
    return std::current_exception();
  }
  return {};
}

void RunDirectory::end(const records::Summary& summary) {
  if (!history_) begin(summary.header);
  has_ended_ = true;
  if (summary.errors) columns_ = columns_text(summary.header, &summary.errors->header);
  std::exception_ptr failure = commit_files();
  if (summary.errors && !failure) failure = commit_text("errors.csv", errors_csv(*summary.errors));
  for (const records::Table& table : summary.tables)
    if (!failure) failure = commit_text(file_of(table), table_csv(table));
  if (summary.linear_model && !failure)
    for (const auto& [name, text] : linear_model_files(*summary.linear_model))
      if (!failure) failure = commit_text(name, text);
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
  OutputFolder folder(directory, owner, all_names);
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
