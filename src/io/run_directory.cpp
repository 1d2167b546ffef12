#include "bough/io/run_directory.hpp"

#include <stdexcept>
#include <system_error>

#include "bough/io/summary.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

#ifdef BOUGH_HAS_VTK
constexpr bool has_vtk = true;
#else
constexpr bool has_vtk = false;  // what stands under it is not compiled: vtu_text and its like are not there
#endif

/// Returns false where there is no such file.
bool remove_file(const fs::path& path) {
  std::error_code error;
  const bool was_there = fs::remove(path, error);
  if (error) throw std::runtime_error("cannot remove " + path.string() + ": " + error.message());
  return was_there;
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw std::runtime_error("cannot make the directory " + path.string() + ": " + error.message());
  if (!fs::is_directory(path, error))
    throw std::runtime_error("cannot write into " + path.string() + ": not a directory");
}

std::string frame_name(std::size_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return "frame_" + digits + ".vtu";
}

bool is_frame_name(const std::string& name) {
  return name.rfind("frame_", 0) == 0 && (name.ends_with(".vtu") || name.ends_with(".vtu.partial"));
}

}  // namespace

RunDirectory::RunDirectory(fs::path directory, std::string version)
    : directory_(std::move(directory)), version_(std::move(version)) {}

void RunDirectory::remove_former_results() {
  if (remove_file(directory_ / "summary.json")) sync_directory(directory_);
  remove_file(directory_ / "motion.pvd");
  remove_file(directory_ / "motion.jsonl");
  const fs::path folder = directory_ / "motion";
  std::error_code error;
  std::vector<fs::path> frames;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (is_frame_name(it->path().filename().string())) frames.push_back(it->path());
  for (const fs::path& frame : frames) remove_file(frame);
  fs::remove(folder, error);  // only where nothing else lies in it
}

void RunDirectory::begin(const results::HistoryHeader& header) {
  make_directory(directory_);
  remove_former_results();
  history_ = std::make_unique<HistoryWriter>(directory_ / "history.csv", header);
}

void RunDirectory::row(const results::HistoryRow& row) {
  if (!history_) throw std::logic_error("RunDirectory: a row before begin");
  history_->row(row);
}

void RunDirectory::motion(const results::MotionFrame& frame) {
  if (!motion_lines_) {
    if constexpr (has_vtk) {
      make_directory(directory_ / "motion");
      vtu_options_ = vtu_options_for(frame);
    }
    motion_lines_ = std::make_unique<MotionLinesWriter>(directory_ / "motion.jsonl");
  }
  if constexpr (has_vtk) {
    const std::string name = frame_name(frames_.size());
    write_file(directory_ / "motion" / name, vtu_text(frame, vtu_options_), Durability::later);
    frames_.push_back({frame.time, "motion/" + name});
  }
  motion_lines_->frame(frame);
}

void RunDirectory::end(const results::Summary& summary) {
  if (!history_) begin(summary.header);
  has_ended_ = true;
  std::exception_ptr failure;
  const auto attempt = [&](const char* name, const auto& write) {
    try {
      write();
      files_.emplace_back(name);
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  };
  const auto commit = [](auto& writer) {
    try {
      writer.commit();
    } catch (const std::exception&) {
      // The rows since the last flush are lost; those before it are whole and may still be given their name.
      if (!writer.can_commit()) throw;
      writer.commit();
      throw;
    }
  };
  attempt("history.csv", [&] { commit(*history_); });
  if (motion_lines_) attempt("motion.jsonl", [&] { commit(*motion_lines_); });
  if constexpr (has_vtk) {
    if (motion_lines_) {
      attempt("motion", [&] {
        for (const PvdEntry& frame : frames_) sync_file(directory_ / frame.file);
        sync_directory(directory_ / "motion");
      });
      attempt("motion.pvd", [&] { write_file(directory_ / "motion.pvd", pvd_text(frames_)); });
    }
  }
  if (failure) std::rethrow_exception(failure);  // no summary: the directory is not whole
  attempt("summary.json", [&] { write_file(directory_ / "summary.json", summary_text(summary, version_)); });
  if (failure) std::rethrow_exception(failure);
}

void RunDirectory::end_as_failed(results::Summary summary, const std::string& cause) {
  if (!has_begun() || has_ended()) return;
  summary.status = results::RunStatus::failed;
  summary.cause = cause;
  end(summary);
}

}  // namespace bough::io
