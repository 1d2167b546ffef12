/// Folders of cases follow the cases: they are found by key, and take the names that the cases have now.
#include "bough/study/case_folders.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "bough/io/atomic_file.hpp"
#include "bough/io/folder_lock.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/study/collect.hpp"
#include "support/scratch_directory.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;

class CaseFolders : public testing::Test {
 protected:
  /// The folder of a case, with its key as content.
  void make(const std::string& name, const std::string& key, io::FolderState state = io::FolderState::good) const {
    io::OutputFolder folder(batch_.path() / name, {.verb = "run", .key = key}, {"history.csv"});
    folder.write("history.csv", key);
    folder.publish(state);
  }
  /// A line of the journal.
  void end(const std::string& name, const std::string& key, CaseStatus status = CaseStatus::ok) {
    CaseResult result;
    result.which.name = name;
    result.status = status;
    Journal(batch_ / journal_file, true).add(key, result);
  }
  /// Names and keys of the cases as they are now.
  CaseList cases(const std::vector<std::pair<std::string, std::string>>& named) const {
    std::vector<BatchCase> list;
    std::vector<std::string> keys;
    for (const auto& [name, key] : named) {
      list.push_back({.name = name, .scene = "scene.json", .directory = batch_.path() / name, .key = key});
      keys.push_back(key);
    }
    const CaseList all(std::move(list));
    io::write_file(batch_ / keys_file, keys_csv(all, keys));
    return all;
  }
  std::vector<fs::path> settle(const CaseList& all) const {
    return settle_case_folders(batch_.path(), all, read_records(batch_ / journal_file));
  }
  /// Key in the folder of this name, by its content; empty where there is none.
  std::string held(const std::string& name) const {
    std::ifstream in(batch_ / name / "history.csv");
    std::string key;
    std::getline(in, key);
    return key;
  }
  support::ScratchDirectory batch_;
};

TEST_F(CaseFolders, leave_nothing_of_writers_that_were_killed_with_nothing_listed) {
  make("1", "x");
  end("1", "x");
  const fs::path bare = batch_.path() / ".1.bough-new", begun = batch_.path() / ".2.bough-new",
                 busy = batch_.path() / ".3.bough-new", foreign = batch_.path() / ".4.bough-new";
  for (const fs::path& folder : {bare, begun, busy, foreign}) fs::create_directory(folder);
  io::write_file(begun / (std::string(io::manifest_name) + ".partial"), "{");
  io::write_file(foreign / "thesis.txt", "of somebody");
  io::FolderLock writer;
  ASSERT_TRUE(writer.take(busy));
  settle(cases({{"1", "x"}}));
  EXPECT_FALSE(fs::exists(bare));
  EXPECT_FALSE(fs::exists(begun));
  EXPECT_TRUE(fs::exists(busy)) << "its writer lives";
  EXPECT_TRUE(fs::exists(foreign / "thesis.txt"));
  EXPECT_EQ(held("1"), "x");
}

TEST_F(CaseFolders, take_the_names_that_the_cases_have_now) {
  for (const auto& [name, key] : {std::pair{"1", "x"}, {"2", "y"}, {"3", "z"}}) {
    make(name, key);
    end(name, key);
  }
  EXPECT_TRUE(settle(cases({{"1", "new"}, {"2", "x"}, {"3", "y"}, {"4", "z"}})).empty());
  EXPECT_EQ(held("1") + held("2") + held("3") + held("4"), "xyz");
  EXPECT_TRUE(settle(cases({{"1", "z"}, {"2", "y"}, {"3", "x"}})).empty());
  EXPECT_EQ(held("1") + held("2") + held("3"), "zyx") << "names may be exchanged";
  EXPECT_TRUE(settle(cases({{"1", "y"}})).empty());
  EXPECT_EQ(held("1"), "y");
  EXPECT_EQ(io::listed_folders(batch_.path()).size(), 1u) << "cases that the batch no longer has";
}

TEST_F(CaseFolders, of_attempts_that_were_stopped_do_not_stand_beside_a_row_that_is_done) {
  make("1", "x", io::FolderState::failed);
  make("2", "y", io::FolderState::failed);
  make("3", "z", io::FolderState::failed);
  end("1", "x");
  end("2", "y", CaseStatus::failed);
  const CaseList all = cases({{"1", "x"}, {"2", "y"}, {"3", "z"}});
  EXPECT_TRUE(settle(all).empty());
  EXPECT_EQ(held("1") + held("2") + held("3"), "yz") << "3 has not ended yet, and is replaced when it does";
}

TEST_F(CaseFolders, with_files_of_others_are_left_aside_and_told) {
  make("1", "x");
  end("1", "x");
  std::ofstream(batch_ / "1/notes.txt") << "mine";
  EXPECT_EQ(settle(cases({{"1", "new"}})), std::vector<fs::path>{batch_ / "1.former"});
  EXPECT_EQ(held("1.former"), "x");
  EXPECT_TRUE(fs::exists(batch_ / "1.former/notes.txt"));
  EXPECT_TRUE(settle(cases({{"1", "x"}})).empty()) << "and stay where they are";
}

TEST_F(CaseFolders, are_found_by_the_key_that_the_name_has_now) {
  make("1", "x");
  end("1", "x");
  end("2", "y", CaseStatus::failed);
  (void)cases({{"1", "x"}, {"2", "y"}});
  ASSERT_TRUE(find_case(batch_.path(), "2"));
  EXPECT_EQ(find_case(batch_.path(), "2")->result->status, CaseStatus::failed);
  EXPECT_FALSE(find_case(batch_.path(), "3"));
  EXPECT_EQ(why_not_of_its_case(batch_ / "1"), "");
  (void)cases({{"1", "y"}, {"2", "x"}});
  EXPECT_EQ(find_case(batch_.path(), "1")->key, "y");
  EXPECT_NE(why_not_of_its_case(batch_ / "1").find("holds results of another case"), std::string::npos);
  (void)cases({{"2", "x"}});
  EXPECT_NE(why_not_of_its_case(batch_ / "1").find("no longer has"), std::string::npos);
}

}  // namespace
}  // namespace bough::study
