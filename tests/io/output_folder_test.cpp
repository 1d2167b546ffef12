/// Folders of results change as a whole, and nothing that is not bough's is touched.
#include "bough/io/output_folder.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> names = {"a.txt", "b.txt", "part/frame_*"};

class Output : public testing::Test {
 protected:
  /// Writes `text` to a.txt and, where told so, a second file.
  void write(const std::string& text, FolderState state = FolderState::good, bool with_frame = false) {
    OutputFolder folder(out_, {"test"}, names);
    folder.write("a.txt", text);
    if (with_frame) {
      fs::create_directory(folder.staging() / "part");
      folder.write("part/frame_0", "frame of " + text);
    }
    folder.publish(state);
    shown_ = folder.folder();
  }
  std::vector<std::string> names_in(const fs::path& folder) const {
    std::vector<std::string> list;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      list.push_back(entry.path().filename().string());
    std::sort(list.begin(), list.end());
    return list;
  }
  /// A writer that is killed after `work`.
  template <class Work>
  void run_and_kill(const Work& work) const {
    const pid_t child = fork();
    if (child == 0) {
      work();
      _exit(9);
    }
    waitpid(child, nullptr, 0);
  }

  ScratchDirectory scratch_;
  fs::path out_ = scratch_ / "out", shown_;
};

TEST_F(Output, stands_under_its_name_when_it_is_whole_and_leaves_nothing_beside) {
  {
    OutputFolder folder(out_, {"test"}, names);
    folder.write("a.txt", "new");
    EXPECT_FALSE(fs::exists(out_));
    folder.publish(FolderState::good);
  }
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
  EXPECT_EQ(names_in(out_), (std::vector<std::string>{"a.txt", "manifest.json"}));
}

TEST_F(Output, former_results_stand_whole_until_the_new_ones_do) {
  write("first", FolderState::good, true);
  {
    OutputFolder folder(out_, {"test"}, names);
    folder.write("a.txt", "second");
    EXPECT_EQ(text_of(out_ / "a.txt"), "first");
    EXPECT_EQ(text_of(out_ / "part/frame_0"), "frame of first");
    folder.publish(FolderState::good);
  }
  EXPECT_EQ(text_of(out_ / "a.txt"), "second");
  EXPECT_FALSE(fs::exists(out_ / "part")) << "nothing of the former results is left";
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

TEST_F(Output, given_up_leaves_the_former_results_and_nothing_else) {
  write("first");
  { OutputFolder(out_, {"test"}, names).write("a.txt", "second"); }
  EXPECT_EQ(text_of(out_ / "a.txt"), "first");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

TEST_F(Output, of_failed_work_stands_beside_good_results_and_replaces_what_failed_before) {
  write("good");
  for (const char* text : {"bad", "worse"}) {
    write(text, FolderState::failed);
    EXPECT_EQ(text_of(out_ / "a.txt"), "good");
    EXPECT_EQ(shown_, scratch_ / "out.failed");
    EXPECT_EQ(text_of(shown_ / "a.txt"), text);
  }
  EXPECT_EQ(names_in(scratch_.path()), (std::vector<std::string>{"out", "out.failed"}));
  write("better");
  EXPECT_EQ(text_of(out_ / "a.txt"), "better");
}

TEST_F(Output, of_failed_work_keeps_its_name_where_there_is_nothing_good) {
  write("bad", FolderState::failed);
  write("worse", FolderState::failed);
  EXPECT_EQ(text_of(out_ / "a.txt"), "worse");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

TEST_F(Output, beside_good_results_never_takes_a_folder_of_somebody_else) {
  write("good");
  fs::create_directory(scratch_ / "out.failed");
  write_file(scratch_ / "out.failed/a.txt", "mine");
  write("bad", FolderState::failed);
  EXPECT_EQ(text_of(scratch_ / "out.failed/a.txt"), "mine");
  EXPECT_EQ(text_of(scratch_ / "out.failed.2/a.txt"), "bad");
}

TEST_F(Output, is_refused_where_something_is_not_boughs) {
  write("first", FolderState::good, true);
  for (const char* foreign : {"notes.txt", "part/mine", "a.txt", "folder/file"}) {
    const fs::path path = out_ / foreign;
    const std::string former = text_of(path);
    fs::create_directories(path.parent_path());
    write_file(path, "mine, and longer than before");
    EXPECT_THROW(OutputFolder(out_, {"test"}, names), OutputRefused) << foreign;
    EXPECT_EQ(text_of(path), "mine, and longer than before");
    EXPECT_EQ(text_of(out_ / "part/frame_0"), "frame of first");
    if (former.empty())
      fs::remove(path);
    else
      write_file(path, former);
  }
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"}) << "no other folder is left";
  write("second");
  EXPECT_EQ(text_of(out_ / "a.txt"), "second");
}

TEST_F(Output, stands_beside_where_files_of_others_appear_while_it_is_written) {
  write("first");
  OutputFolder folder(out_, {"test"}, names);
  folder.write("a.txt", "second");
  write_file(out_ / "notes.txt", "mine");
  folder.publish(FolderState::good);
  EXPECT_EQ(text_of(out_ / "notes.txt"), "mine");
  EXPECT_EQ(text_of(out_ / "a.txt"), "first");
  EXPECT_EQ(text_of(scratch_ / "out.failed/a.txt"), "second");
  EXPECT_NE(folder.why_beside().find("did not write"), std::string::npos);
}

TEST_F(Output, follows_no_link_out_of_its_folder) {
  fs::create_directory(scratch_ / "precious");
  write_file(scratch_ / "precious/frame_0", "mine");
  write("first", FolderState::good, true);
  fs::remove_all(out_ / "part");
  fs::create_directory_symlink(scratch_ / "precious", out_ / "part");
  EXPECT_THROW(OutputFolder(out_, {"test"}, names), OutputRefused);
  EXPECT_EQ(text_of(scratch_ / "precious/frame_0"), "mine");
}

TEST_F(Output, goes_where_a_link_of_the_users_leads) {
  fs::create_directory(scratch_ / "disk");
  fs::create_directory_symlink(scratch_ / "disk", out_);
  write("first");
  write("second");
  EXPECT_TRUE(fs::is_symlink(out_));
  EXPECT_EQ(text_of(scratch_ / "disk/a.txt"), "second");
}

TEST_F(Output, of_a_second_writer_is_refused_and_does_not_disturb_the_first) {
  write("former", FolderState::good, true);
  OutputFolder first(out_, {"test"}, names);
  first.write("a.txt", "first");
  EXPECT_THROW(OutputFolder(out_, {"test"}, names), std::runtime_error);
  EXPECT_EQ(text_of(out_ / "part/frame_0"), "frame of former");
  first.publish(FolderState::good);
  EXPECT_EQ(text_of(out_ / "a.txt"), "first");
}

TEST_F(Output, takes_over_what_a_killed_writer_left) {
  write("former");
  run_and_kill([&] {
    auto* folder = new OutputFolder(out_, {"test"}, names);
    folder->write("a.txt", "lost");
    AtomicFile half(folder->staging() / "b.txt");
    half.write("half");
    half.flush();
    _exit(9);
  });
  EXPECT_EQ(text_of(out_ / "a.txt"), "former");
  write("new");
  EXPECT_EQ(text_of(out_ / "a.txt"), "new");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

TEST_F(Output, never_takes_away_a_folder_that_only_has_the_name_of_a_writers) {
  fs::create_directory(scratch_ / ".out.bough-new");
  write_file(scratch_ / ".out.bough-new/a.txt", "mine");
  EXPECT_THROW(OutputFolder(out_, {"test"}, names), OutputRefused);
  EXPECT_EQ(text_of(scratch_ / ".out.bough-new/a.txt"), "mine");
}

TEST_F(Output, into_the_folder_that_the_process_stands_in_changes_its_entries) {
  const fs::path home = fs::current_path();
  fs::create_directory(out_);
  fs::current_path(out_);
  out_ = ".";
  write("first", FolderState::good, true);
  write("second");
  EXPECT_EQ(names_in("."), (std::vector<std::string>{"a.txt", "manifest.json"}));
  EXPECT_EQ(text_of("a.txt"), "second");
  write("bad", FolderState::failed);
  EXPECT_EQ(text_of("a.txt"), "second");
  EXPECT_EQ(text_of(scratch_ / "out.failed/a.txt"), "bad");
  EXPECT_EQ(shown_, "../out.failed");
  fs::current_path(home);
}

/// The state between the two moves of entries, made by hand.
TEST_F(Output, puts_back_what_a_kill_left_half_way) {
  write("former", FolderState::good, true);
  const fs::path staging = scratch_ / ".out.bough-new";
  fs::create_directories(staging / ".former");
  for (const char* name : {"manifest.json", "a.txt", "part"}) fs::rename(out_ / name, staging / ".former" / name);
  write_file(out_ / "a.txt", "new");
  write_file(staging / "manifest.json",
             manifest_text({"test", FolderState::good, "", {{"a.txt", 3, digest_of("new")}}}));
  OutputFolder folder(out_, {"test"}, names);
  EXPECT_EQ(text_of(out_ / "a.txt"), "former");
  EXPECT_EQ(text_of(out_ / "part/frame_0"), "frame of former");
  folder.write("a.txt", "newer");
  folder.publish(FolderState::good);
  EXPECT_EQ(text_of(out_ / "a.txt"), "newer");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

/// The same left within the folder by a writer that stood in it.
TEST_F(Output, puts_back_what_a_kill_left_half_way_within_it) {
  write("former");
  const fs::path staging = out_ / ".bough-new";
  fs::create_directories(staging / ".former");
  for (const char* name : {"manifest.json", "a.txt"}) fs::rename(out_ / name, staging / ".former" / name);
  write_file(staging / "a.txt", "new");
  write_file(staging / "manifest.json",
             manifest_text({"test", FolderState::good, "", {{"a.txt", 3, digest_of("new")}}}));
  { const OutputFolder folder(out_, {"test"}, names); }
  EXPECT_EQ(text_of(out_ / "a.txt"), "former");
  EXPECT_EQ(names_in(out_), (std::vector<std::string>{"a.txt", "manifest.json"}));
}

TEST_F(Output, takes_over_from_a_writer_that_was_killed_before_its_first_file_had_a_name) {
  fs::create_directory(scratch_ / ".out.bough-new");
  write_file(scratch_ / ".out.bough-new/manifest.json.partial", "{");
  write("first");
  EXPECT_EQ(text_of(out_ / "a.txt"), "first");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

TEST_F(Output, waits_for_a_writer_that_is_about_to_end) {
  write("former");
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    OutputFolder folder(out_, {"test"}, names);
    folder.write("a.txt", "unfinished");
    (void)::write(ready[1], "", 1);
    usleep(200'000);
    _exit(9);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  write("second");
  EXPECT_EQ(text_of(out_ / "a.txt"), "second");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
  waitpid(child, nullptr, 0);
  for (const int end : ready) close(end);
}

// A thread of a study that adds the names of a reference, on a disk that lets it wait.
TEST_F(Output, a_line_waits_for_others_that_add_theirs_however_long_it_takes) {
  fs::create_directory(out_);
  FolderLock held;
  ASSERT_TRUE(held.take(out_));
  std::thread slow([&held] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    held.release();
  });
  EXPECT_NO_THROW(list_file(out_, {"test"}, "a.txt"));
  slow.join();
}

// As many threads as a large study has, each with as many references.
TEST_F(Output, lines_of_many_threads_all_stand_in_the_manifest) {
  constexpr int num_threads = 16, lines = 40;
  std::atomic<int> failures{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < num_threads; ++t)
    threads.emplace_back([&, t] {
      try {
        fs::create_directories(out_);
        for (int k = 0; k < lines; ++k) list_file(out_, {"test"}, std::to_string(t) + "." + std::to_string(k));
      } catch (const std::exception&) {
        ++failures;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(read_manifest(out_).value().files.size(), static_cast<std::size_t>(num_threads * lines));
}

TEST_F(Output, a_run_begins_while_lines_are_added_and_ends_the_waiting_of_none) {
  write("first");
  std::atomic<bool> done{false};
  std::atomic<int> failures{0};
  std::thread lines([&] {
    while (!done) try {
        list_file(out_, {"view"}, "page.html");
      } catch (const std::exception&) {
        ++failures;
      }
  });
  for (int k = 0; k < 20; ++k) EXPECT_NO_THROW(write("again"));
  done = true;
  lines.join();
  EXPECT_EQ(failures, 0);
}

TEST_F(Output, a_run_that_holds_the_folder_is_not_waited_for) {
  write("first");
  const OutputFolder run(out_, {"test"}, names);
  EXPECT_THROW(list_file(out_, {"view"}, "page.html"), std::runtime_error);
}

TEST_F(Output, takes_folders_of_other_results_along) {
  write("first");
  {
    OutputFolder guest(out_ / "guest", {"test"}, names);
    guest.write("a.txt", "guest");
    guest.publish(FolderState::good);
  }
  write("second");
  EXPECT_EQ(text_of(out_ / "a.txt"), "second");
  EXPECT_EQ(text_of(out_ / "guest/a.txt"), "guest");
}

TEST_F(Output, is_refused_where_it_would_replace_what_is_read) {
  write("first");
  EXPECT_THROW(OutputFolder(out_, {"test"}, names, {out_ / "a.txt"}), OutputRefused);
  fs::create_symlink(out_ / "a.txt", scratch_ / "link");
  EXPECT_THROW(OutputFolder(out_, {"test"}, names, {scratch_ / "link"}), OutputRefused);
  EXPECT_NO_THROW(OutputFolder(out_, {"test"}, names, {scratch_ / "other.json"}));
}

TEST_F(Output, file_that_is_listed_later_goes_with_the_folder) {
  write("first");
  write_listed_file(out_, {"view"}, "page.html", "a page");
  write_listed_file(out_, {"view"}, "page.html", "another page");
  EXPECT_TRUE(foreign_entries(out_).empty());
  write("second");
  EXPECT_FALSE(fs::exists(out_ / "page.html"));
}

TEST_F(Output, collections_hold_folders_and_files_of_their_own) {
  {
    OutputCollection all(out_, {"test"});
    OutputFolder part(out_ / "part", {"test"}, names);
    part.write("a.txt", "x");
    part.publish(FolderState::good);
    all.write("table.csv", "1");
  }
  EXPECT_NO_THROW(OutputCollection(out_, {"test"}).write("table.csv", "longer"));
  write_file(out_ / "mine", "mine");
  EXPECT_THROW(OutputCollection(out_, {"test"}), OutputRefused);
}

/// A case of a batch whose writer was killed before its first manifest had its name.
TEST_F(Output, collections_take_over_folders_that_were_just_begun) {
  const fs::path begun = OutputFolder::staging_of(out_ / "part");
  fs::create_directories(begun);
  write_file(begun / "manifest.json.partial", "{");
  EXPECT_NO_THROW(OutputCollection(out_, {"test"}));
  OutputFolder part(out_ / "part", {"test"}, names);
  part.write("a.txt", "x");
  part.publish(FolderState::good);
  EXPECT_EQ(text_of(out_ / "part/a.txt"), "x");
  EXPECT_FALSE(fs::exists(begun));
  fs::create_directories(out_ / "mine");
  write_file(out_ / "mine/manifest.json.partial", "{");
  write_file(out_ / "mine/thesis.txt", "mine");
  EXPECT_THROW(OutputCollection(out_, {"test"}), OutputRefused);
}

TEST_F(Output, of_another_owner_is_replaced_only_where_that_is_asked_for) {
  const auto owner = [&](const std::string& verb, const char* source, const char* key = "") {
    return Owner{.verb = verb, .source = scratch_ / source, .key = key};
  };
  const auto write_as = [&](const Owner& who, const std::string& text) {
    OutputFolder folder(out_, who, names);
    folder.write("a.txt", text);
    folder.publish(FolderState::good);
  };
  write_as(owner("run", "one.json"), "first");
  for (const Owner& other : {owner("run", "two.json"), owner("profile", "one.json"), owner("run", "one.json", "key")}) {
    EXPECT_THROW(write_as(other, "other"), OutputRefused);
    EXPECT_THROW(OutputCollection(out_, other, {}, Writers::one), OutputRefused);
  }
  EXPECT_EQ(text_of(out_ / "a.txt"), "first");
  write_as(owner("run", "one.json"), "second");
  EXPECT_EQ(text_of(out_ / "a.txt"), "second") << "of the same owner";
  Owner replacing = owner("run", "two.json");
  replacing.replaces = true;
  write_as(replacing, "third");
  EXPECT_EQ(text_of(out_ / "a.txt"), "third");
  fs::rename(scratch_ / "out", scratch_ / "elsewhere");
  EXPECT_EQ(read_manifest(scratch_ / "elsewhere").value().source, "../two.json") << "they may be moved together";
}

TEST_F(Output, that_was_changed_without_changing_its_size_is_foreign) {
  write("first");
  std::ofstream(out_ / "a.txt") << "mine!";
  EXPECT_EQ(foreign_entries(out_), std::vector<std::string>{"a.txt"});
  EXPECT_THROW(write("second"), OutputRefused);
  EXPECT_EQ(text_of(out_ / "a.txt"), "mine!");
}

TEST_F(Output, of_many_results_has_one_writer_who_locks_out_runs_and_is_locked_out_by_them) {
  const auto is_refused = [](const auto& make) {
    try {
      make();
      return false;
    } catch (const std::runtime_error&) {
      return true;
    }
  };
  const auto in_another_process = [&](const auto& make) {
    const pid_t child = fork();
    if (child == 0) _exit(is_refused(make) ? 1 : 0);
    int status = -1;
    waitpid(child, &status, 0);
    return WEXITSTATUS(status) == 0;
  };
  const auto collect = [&] { OutputCollection(out_, {"test"}, {}, Writers::one); };
  {
    const OutputFolder run(out_, {"test"}, names);
    EXPECT_FALSE(in_another_process(collect));
  }
  {
    const OutputCollection all(out_, {"test"}, {}, Writers::one);
    EXPECT_FALSE(in_another_process(collect));
  }
  EXPECT_TRUE(in_another_process(collect));
}

TEST_F(Output, of_many_results_is_replaced_as_a_whole_when_the_new_ones_are_good) {
  const fs::path former = scratch_ / "out.former";
  const auto table_of = [&](const std::string& text, bool replaces, FolderState state) {
    OutputCollection all(out_, {.verb = "test", .replaces = replaces}, {}, Writers::one);
    EXPECT_EQ(read_manifest(out_).value().state, FolderState::unfinished);
    all.write("table.csv", text);
    OutputFolder part(out_ / "1", {.verb = "run", .key = "key of " + text}, names);
    part.write("a.txt", text);
    part.publish(FolderState::good);
    return all.publish(state);
  };
  EXPECT_FALSE(table_of("first", false, FolderState::good));
  EXPECT_EQ(read_manifest(out_).value().files.at(0).hash, digest_of("first"));
  EXPECT_EQ(table_of("second", true, FolderState::failed), former);
  EXPECT_EQ(text_of(former / "table.csv") + text_of(former / "1/a.txt"), "firstfirst");
  EXPECT_EQ(text_of(out_ / "table.csv") + text_of(out_ / "1/a.txt"), "secondsecond");
  EXPECT_FALSE(table_of("third", true, FolderState::good));
  EXPECT_EQ(text_of(out_ / "table.csv") + text_of(out_ / "1/a.txt"), "thirdthird");
  EXPECT_EQ(names_in(scratch_.path()), std::vector<std::string>{"out"});
}

TEST(Overwriting, is_told_by_whatever_path) {
  const ScratchDirectory scratch;
  write_file(scratch / "a", "a");
  fs::create_symlink(scratch / "a", scratch / "link");
  fs::create_hard_link(scratch / "a", scratch / "hard");
  EXPECT_THROW(refuse_to_overwrite({scratch / "a"}, {scratch / "a"}), OutputRefused);
  EXPECT_THROW(refuse_to_overwrite({scratch / "a"}, {scratch / "link"}), OutputRefused);
  EXPECT_THROW(refuse_to_overwrite({scratch / "a"}, {scratch / "hard"}), OutputRefused);
  EXPECT_THROW(refuse_to_overwrite({scratch / "a"}, {scratch.path() / "." / ".." / scratch.path().filename() / "a"}),
               OutputRefused);
  EXPECT_THROW(refuse_to_overwrite({}, {scratch / "new", scratch / "new"}), OutputRefused);
  EXPECT_NO_THROW(refuse_to_overwrite({scratch / "a", ""}, {scratch / "b", "", ""}));
}

TEST(Manifest, with_names_that_lead_out_of_the_folder_is_none) {
  const ScratchDirectory scratch;
  for (const char* name : {"../precious", "/etc/passwd", "a/../../b"}) {
    write_file(scratch / "manifest.json", manifest_text({"test", FolderState::good, "", {{name}}}));
    EXPECT_FALSE(read_manifest(scratch.path())) << name;
  }
}

}  // namespace
}  // namespace bough::io
