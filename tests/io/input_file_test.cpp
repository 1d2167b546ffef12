/// One door for files that are read: regular files alone, at once, and no larger than they may be.
#include "bough/io/input_file.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>

#include "bough/io/columns.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/history.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/read_sweep.hpp"
#include "bough/io/run_store.hpp"
#include "bough/io/summary.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

/// What is no file: each under its own name in a folder.
class NoFiles : public testing::Test {
 protected:
  void SetUp() override {
    EXPECT_EQ(mkfifo((scratch_ / "pipe").c_str(), 0600), 0);
    fs::create_symlink("loop", scratch_ / "loop");
    fs::create_symlink("/dev/zero", scratch_ / "zero");
    fs::create_symlink("nowhere", scratch_ / "dangling");
    fs::create_directory(scratch_ / "folder");
    alarm(20);  // a reader that waits for a pipe, or reads zeros without end, ends the test
  }
  void TearDown() override { alarm(0); }
  const std::vector<std::pair<std::string, std::string>> names_ = {{"pipe", "this is a pipe"},
                                                                   {"loop", "a link that leads to itself"},
                                                                   {"zero", "a device"},
                                                                   {"dangling", "no such file"},
                                                                   {"folder", "a directory"}};
  support::ScratchDirectory scratch_;
};

std::string fault_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no fault";
}

TEST_F(NoFiles, every_reader_says_at_once_what_they_are) {
  for (const auto& [name, why] : names_) {
    const fs::path file = scratch_ / name;
    EXPECT_NE(fault_of([&] { (void)read_text(file); }).find(why), std::string::npos) << name;
    EXPECT_NE(fault_of([&] { (void)digest_of_file(file); }).find(why), std::string::npos) << name;
    EXPECT_NE(fault_of([&] { (void)read_history(file); }).find(why), std::string::npos) << name;
    EXPECT_NE(fault_of([&] { (void)read_summary(file); }).find(why), std::string::npos) << name;
    EXPECT_NE(fault_of([&] { (void)read_motion_file(file, 3); }).find(why), std::string::npos) << name;
    for (const std::vector<Problem>& problems : {read_scene(file).problems, read_sweep(file).problems}) {
      ASSERT_EQ(problems.size(), 1u) << name;
      EXPECT_NE(problems[0].text().find(why), std::string::npos) << problems[0].text();
    }
    EXPECT_FALSE(read_stored(scratch_.path(), {name, 0}, "key"));
  }
  records::HistoryHeader header;
  EXPECT_THROW(read_columns(scratch_ / "pipe", header), std::runtime_error);
  fs::create_directory(scratch_ / "run");
  EXPECT_EQ(mkfifo((scratch_ / "run/manifest.json").c_str(), 0600), 0);
  EXPECT_FALSE(read_manifest(scratch_ / "run"));
}

TEST_F(NoFiles, a_large_file_is_refused_by_its_size_and_not_read) {
  const fs::path file = scratch_ / "large.json";
  std::ofstream(file) << "{}";
  fs::resize_file(file, std::uintmax_t{1} << 40u);  // holds no blocks
  EXPECT_EQ(fault_of([&] { (void)read_text(file, max_file_bytes); }),
            "cannot read " + file.string() + ": the file is larger than 32 MB");
  EXPECT_NE(read_scene(file).problems.at(0).text().find("larger than 32 MB"), std::string::npos);
  EXPECT_NE(fault_of([&] { (void)read_summary(file); }).find("larger than 32 MB"), std::string::npos);
}

TEST_F(NoFiles, a_result_of_another_size_is_no_result_before_its_hash_is_computed) {
  const fs::path run = scratch_ / "run";
  OutputFolder folder(run, {"run"}, {"history.csv", "summary.json"});
  const std::string rows = "time,step_size,iterations\n0,0,0\n";
  folder.write("history.csv", rows);
  folder.write_index("summary.json",
                     summary_text(sample_summary(), "1", {}, {{"history.csv", rows.size(), digest_of(rows)}}));
  folder.publish(FolderState::good);
  EXPECT_EQ(read_whole_summary(run, {"history.csv"}).status, "ok");
  fs::resize_file(run / "history.csv", std::uintmax_t{1} << 42u);
  EXPECT_NE(fault_of([&] { (void)read_whole_summary(run, {"history.csv"}); }).find("is not the file"),
            std::string::npos);
}

TEST_F(NoFiles, lines_are_those_of_the_text_and_the_last_one_may_lack_its_end) {
  const std::string long_line(200'000, 'x');
  for (const std::string& end : {std::string(), std::string("\n")}) {
    std::ofstream(scratch_ / "lines", std::ios::binary) << "a\n\n" << long_line << "\nlast" << end;
    InputFile file(scratch_ / "lines");
    std::vector<std::string> lines;
    for (std::string line; file.next_line(line);) lines.push_back(line);
    EXPECT_EQ(lines, (std::vector<std::string>{"a", "", long_line, "last"}));
    EXPECT_EQ(file.ends_with_line_end(), !end.empty());
    char bytes[3] = {};
    EXPECT_EQ(file.read(200'004, bytes, 3), 3u);
    EXPECT_EQ(std::string(bytes, 3), "las");
    EXPECT_EQ(file.read(~std::uint64_t{0}, bytes, 3), 0u) << "beyond the end";
  }
}

TEST(Numbers, of_files_become_the_nearest_integer_of_the_type) {
  EXPECT_EQ(whole_number<int>(1e150), std::numeric_limits<int>::max());
  EXPECT_EQ(whole_number<int>(-1e150), std::numeric_limits<int>::min());
  EXPECT_EQ(whole_number<long>(1e300), std::numeric_limits<long>::max());
  EXPECT_EQ(whole_number<std::uint64_t>(-3.0), 0u);
  EXPECT_EQ(whole_number<std::uint64_t>(1e300), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(whole_number<int>(std::nan("")), 0);
  EXPECT_EQ(whole_number<int>(-7.9), -7);
}

}  // namespace
}  // namespace bough::io
