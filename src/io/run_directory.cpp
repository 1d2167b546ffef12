#include "bough/io/run_directory.hpp"

#include <stdexcept>
#include <system_error>

#include "bough/io/columns.hpp"
#include "bough/io/input_file.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

#ifdef BOUGH_HAS_VTK
constexpr bool has_vtk = true;
#else
constexpr bool has_vtk = false;  // the code below it is not compiled, since vtu_text is not available
#endif

const std::vector<std::string> all_names = {"history.csv", "history.npy",    "columns.json", "motion.bin",
                                            "motion.pvd",  "motion/frame_*", "summary.json"};

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

RunDirectory::RunDirectory(fs::path directory, std::string version, RunOrigin origin, bool replaces)
    : directory_(std::move(directory)), version_(std::move(version)), origin_(std::move(origin)), replaces_(replaces) {}

void RunDirectory::open() {
  if (folder_) return;
  const Owner owner{"run", origin_.scene_file, origin_.key, replaces_};
  folder_ = std::make_unique<OutputFolder>(directory_, owner, all_names, origin_.inputs());
}

void RunDirectory::begin(const records::HistoryHeader& header) {
  open();
  history_ = std::make_unique<HistoryWriter>(folder_->staging() / "history.csv", header);
  twin_ = std::make_unique<NpyHistoryWriter>(folder_->staging() / "history.npy", header);
  columns_ = columns_text(header);
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
    write_file(folder_->staging() / "columns.json", columns_, Durability::soon);
    list({"columns.json", columns_.size(), digest_of(columns_)});
  });
  if (motion_) attempt("motion.bin", [&] { commit(*motion_); });
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

void RunDirectory::end(const records::Summary& summary) {
  if (!history_) begin(summary.header);
  has_ended_ = true;
  std::exception_ptr failure = commit_files();
  if (!failure) {  // otherwise there is no summary, since the directory is incomplete
    try {
      folder_->write_index("summary.json", summary_text(summary, version_, origin_, records_));
      files_.emplace_back("summary.json");
    } catch (...) {
      failure = std::current_exception();
    }
  }
  const bool is_good = !failure && summary.status == records::RunStatus::ok;
  try {
    folder_->publish(is_good ? FolderState::good : FolderState::failed);
  } catch (...) {
    if (!failure) failure = std::current_exception();
  }
  if (failure) std::rethrow_exception(failure);
}

std::optional<fs::path> RunDirectory::keep_rows_of_killed(const fs::path& directory, const Owner& owner) {
  std::string rows, twin;
  {
    FolderLock lock;
    const fs::path staging = OutputFolder::staging_of(directory);
    if (!lock.take(staging) || !read_manifest(staging)) return std::nullopt;
    const auto bytes_of = [&](const char* name) {
      return fs::exists(staging / name) ? read_text(staging / name) : std::string();
    };
    rows = bytes_of("history.csv.partial");
    twin = bytes_of("history.npy.partial");
  }
  rows.resize(rows.rfind('\n') + 1);  // complete rows only; npos + 1 is 0
  if (rows.empty()) return std::nullopt;
  std::vector<std::string> columns;
  if (split_csv_line(std::string_view(rows).substr(0, rows.find('\n')), columns))
    twin = repaired_npy(std::move(twin), columns.size());
  OutputFolder folder(directory, owner, all_names);
  folder.write("history.csv", rows);
  if (!twin.empty()) folder.write("history.npy", twin);
  folder.publish(FolderState::failed);
  return folder.folder();
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
  end(summary);
}

}  // namespace bough::io
