#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "bough/io/atomic_file.hpp"
#include "bough/io/run_directory.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// While it lives no file may grow beyond `bytes`: writes past it fail as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &former_);
    former_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, former_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit former_{};
  void (*former_handler_)(int) = nullptr;
};

TEST(AtomicFile, appears_only_when_committed_and_leaves_nothing_beside_it) {
  const ScratchDirectory scratch;
  {
    AtomicFile file(scratch / "a.txt");
    file.write("whole");
    file.flush();
    EXPECT_FALSE(fs::exists(scratch / "a.txt"));
    file.commit();
  }
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(text_of(scratch / "a.txt"), "whole");
}

TEST(AtomicFile, given_up_keeps_the_former_content) {
  const ScratchDirectory scratch;
  write_file(scratch / "a.txt", "former");
  {
    AtomicFile file(scratch / "a.txt");
    file.write("half");
    file.flush();
  }
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(text_of(scratch / "a.txt"), "former");
}

TEST(AtomicFile, a_second_writer_of_the_same_file_is_refused) {
  const ScratchDirectory scratch;
  AtomicFile first(scratch / "a.txt");
  first.write("first");
  EXPECT_THROW(AtomicFile(scratch / "a.txt"), std::runtime_error);
  first.commit();
  EXPECT_EQ(text_of(scratch / "a.txt"), "first");
}

TEST(AtomicFile, does_not_write_through_a_link) {
  const ScratchDirectory scratch;
  write_file(scratch / "precious", "untouched");
  fs::create_symlink(scratch / "precious", scratch / "a.txt.partial");
  EXPECT_THROW(write_file(scratch / "a.txt", "new"), std::runtime_error);
  fs::create_symlink(scratch / "precious", scratch / "b.txt");
  write_file(scratch / "b.txt", "new");  // replaces the link itself
  EXPECT_EQ(text_of(scratch / "precious"), "untouched");
  EXPECT_EQ(text_of(scratch / "b.txt"), "new");
}

TEST(AtomicFile, says_which_file_and_why_where_it_cannot_be_made) {
  const ScratchDirectory scratch;
  try {
    write_file(scratch / "none/a.txt", "x");
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.txt: No such file or directory"), std::string::npos) << error.what();
  }
  fs::create_directory(scratch / "folder");
  EXPECT_THROW(write_file(scratch / "folder", "x"), std::runtime_error);
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"folder"});
}

TEST(AtomicFile, never_takes_the_place_of_a_device_or_a_pipe) {
  const ScratchDirectory scratch;
  const std::string pipe = scratch / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("/dev/null", scratch / "link");
  for (const char* name : {"pipe", "link"}) EXPECT_THROW(write_file(scratch / name, "x"), std::runtime_error) << name;
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(fs::is_character_file(fs::status("/dev/null")));
  EXPECT_EQ(names_in(scratch.path()), (std::vector<std::string>{"link", "pipe"})) << "no partial file either";
}

TEST(AtomicFile, cut_short_by_a_full_disk_holds_whole_flushes_only) {
  const ScratchDirectory scratch;
  AtomicFile file(scratch / "a.txt");
  {
    const FileSizeLimit limit(1000);
    file.write(std::string(600, 'a'));
    file.flush();
    file.write(std::string(600, 'b'));
    EXPECT_THROW(file.flush(), std::runtime_error);
  }
  ASSERT_TRUE(file.is_open());
  file.write("end");
  file.commit();
  EXPECT_EQ(text_of(scratch / "a.txt"), std::string(600, 'a') + "end");
}

TEST(RunDirectory, writes_every_file_and_all_of_them_appear_together) {
  const ScratchDirectory scratch;
  RunDirectory run(scratch / "out", "1.2.3");
  EXPECT_FALSE(fs::exists(scratch / "out")) << "before begin nothing is made";
  run.begin(sample_summary().header);
  run.row({0.0, 0.0, 0, {1.0, 2.0, 3.0}});
  run.motion(sample_frame(0.0));
  run.motion(sample_frame(1.0));
  EXPECT_FALSE(fs::exists(scratch / "out"));
  run.end(sample_summary());
  EXPECT_EQ(run.files(), (std::vector<std::string>{"history.csv", "columns.json", "motion.bin", "motion", "motion.pvd",
                                                   "summary.json"}));
  EXPECT_EQ(names_in(scratch / "out"),
            (std::vector<std::string>{"columns.json", "history.csv", "manifest.json", "motion", "motion.bin",
                                      "motion.pvd", "summary.json"}));
  EXPECT_EQ(names_in(scratch / "out/motion"), (std::vector<std::string>{"frame_000000.vtu", "frame_000001.vtu"}));
  EXPECT_TRUE(foreign_entries(scratch / "out").empty());
}

TEST(RunDirectory, a_new_run_keeps_the_former_results_until_its_end_and_is_refused_beside_files_of_others) {
  const ScratchDirectory scratch;
  const auto write = [&](int frames, records::RunStatus status) {
    RunDirectory run(scratch / "out", "1");
    run.begin({{"a"}});
    for (int k = 0; k < frames; ++k) run.motion(sample_frame(k));
    records::Summary summary;
    summary.status = status;
    summary.header.columns = {"a"};
    run.end(summary);
  };
  write(3, records::RunStatus::ok);
  {
    RunDirectory second(scratch / "out", "1");
    second.begin({{"a"}});
    EXPECT_EQ(names_in(scratch / "out/motion").size(), 3u);
    EXPECT_TRUE(fs::exists(scratch / "out/summary.json"));
    RunDirectory third(scratch / "out", "1");
    EXPECT_THROW(third.begin({{"a"}}), std::runtime_error);
  }
  write(1, records::RunStatus::failed);
  EXPECT_EQ(names_in(scratch / "out/motion").size(), 3u) << "a run that fails keeps good results";
  EXPECT_EQ(names_in(scratch / "out.failed/motion").size(), 1u);
  write(2, records::RunStatus::ok);
  EXPECT_EQ(names_in(scratch / "out/motion").size(), 2u);
  write_file(scratch / "out/motion/frame_mine.vtu", "mine");
  EXPECT_THROW(write(1, records::RunStatus::ok), OutputRefused);
  EXPECT_TRUE(fs::exists(scratch / "out/motion/frame_mine.vtu"));
}

TEST(RunDirectory, a_run_that_is_given_up_leaves_no_half_written_file) {
  const ScratchDirectory scratch;
  {
    RunDirectory run(scratch / "out", "1");
    run.begin({{"a"}});
    run.row({0.0, 0.0, 0, {1.0}});
  }
  EXPECT_TRUE(names_in(scratch.path()).empty());
}

TEST(RunDirectory, a_full_disk_keeps_the_rows_written_before_it) {
  const ScratchDirectory scratch;
  RunDirectory run(scratch / "out", "1");
  run.begin({{"a"}});
  std::string cause;
  {
    const FileSizeLimit limit(100'000);  // the second flush of 64 KiB fails
    try {
      for (int k = 0; k < 100'000; ++k) run.row({0.5 * k, 0.5, 1, {1.0 / 3.0}});
    } catch (const std::runtime_error& error) {
      cause = error.what();
    }
  }
  EXPECT_NE(cause.find("history.csv: File too large"), std::string::npos) << cause;
  records::Summary summary;
  summary.cause = cause;
  run.end(summary);
  const History history = read_history(scratch / "out/history.csv");
  ASSERT_GT(history.rows.size(), 1000u);
  EXPECT_EQ(history.rows.back().time, 0.5 * static_cast<double>(history.rows.size() - 1))
      << "no row is missing before the last";
  EXPECT_TRUE(fs::exists(scratch / "out/summary.json"));
}

TEST(RunDirectory, without_room_for_the_history_there_is_no_summary_and_the_reason_is_told) {
  const ScratchDirectory scratch;
  RunDirectory run(scratch / "out", "1");
  run.begin({{"a"}});
  run.row({0.0, 0.0, 0, {1.0}});
  records::Summary summary;
  {
    const FileSizeLimit limit(30);  // the header of 28 bytes is in, the row is not
    EXPECT_THROW(run.end(summary), std::runtime_error);
  }
  EXPECT_FALSE(fs::exists(scratch / "out/summary.json"));
  EXPECT_TRUE(read_history(scratch / "out/history.csv").rows.empty());
}

TEST(RunDirectory, a_directory_that_cannot_be_made_is_told) {
  const ScratchDirectory scratch;
  write_file(scratch / "file", "x");
  RunDirectory below_file(scratch / "file/out", "1");
  EXPECT_THROW(below_file.begin({{"a"}}), std::runtime_error);
  RunDirectory on_file(scratch / "file", "1");
  EXPECT_THROW(on_file.begin({{"a"}}), std::runtime_error);
  EXPECT_EQ(text_of(scratch / "file"), "x");
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"file"});
}

/// Where a standard stream is closed, the next file that is opened gets its number.
TEST(AtomicFile, never_takes_the_place_of_a_standard_stream) {
  const ScratchDirectory scratch;
  const int kept = dup(STDIN_FILENO);
  close(STDIN_FILENO);
  {
    AtomicFile file(scratch / "a.txt");
    EXPECT_EQ(fcntl(STDIN_FILENO, F_GETFD), -1) << "nothing stands there";
    file.write("whole");
    file.commit();
  }
  if (kept >= 0) {
    dup2(kept, STDIN_FILENO);
    close(kept);
  }
  EXPECT_EQ(text_of(scratch / "a.txt"), "whole");
}

}  // namespace
}  // namespace bough::io
