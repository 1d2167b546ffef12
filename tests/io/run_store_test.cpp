// Stores of runs: what is written comes back whole, and what is damaged or cut off is not there.
#include "bough/io/run_store.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "bough/io/atomic_file.hpp"
#include "bough/io/run_directory.hpp"
#include "io/write_samples.hpp"

namespace bough::io {
namespace {

class RunStores : public testing::Test {
 protected:
  std::string text() const { return text_of(scratch_ / "store_000.pack"); }
  void put(const std::string& bytes) const {
    std::ofstream(scratch_ / "store_000.pack", std::ios::binary | std::ios::trunc) << bytes;
  }
  ScratchDirectory scratch_;
};

const std::vector<StoredFile> two_files = {{"history.csv", "time\n0\n"}, {"summary.json", std::string("{}\0\n\n", 5)}};

TEST_F(RunStores, records_come_back_with_all_their_bytes) {
  std::vector<StoredPlace> places;
  {
    RunStore store(scratch_.path());
    for (std::size_t k = 0; k < 3; ++k)
      places.push_back(store.add({two_files[0], {"n", std::string(10'000 * k, 'x')}}, "key"));
    places.push_back(store.add({}, "key"));
  }
  {
    RunStore again(scratch_.path());
    places.push_back(again.add(two_files, "key"));
  }
  EXPECT_EQ(places.back().store, "store_000.pack");
  for (int k = 0; k < 3; ++k) {
    const auto files = read_stored(scratch_.path(), places[static_cast<std::size_t>(k)], "key");
    ASSERT_TRUE(files && files->size() == 2);
    EXPECT_EQ((*files)[0].text, two_files[0].text);
    EXPECT_EQ((*files)[1].text.size(), 10'000u * static_cast<std::size_t>(k));
  }
  EXPECT_TRUE(read_stored(scratch_.path(), places[3], "key")->empty());
  EXPECT_EQ(read_stored(scratch_.path(), places[4], "key")->at(1).text, two_files[1].text);
}

TEST_F(RunStores, every_cut_and_every_changed_byte_is_found) {
  StoredPlace place;
  {
    RunStore store(scratch_.path());
    (void)store.add({{"a", "first"}}, "key");
    place = store.add(two_files, "key");
  }
  const std::string whole = text();
  for (std::size_t n = 0; n + 1 < whole.size(); ++n) {
    put(whole.substr(0, n));
    EXPECT_FALSE(read_stored(scratch_.path(), place, "key")) << n;
  }
  for (std::size_t n = place.offset; n + 1 < whole.size(); ++n) {
    std::string other = whole;
    other[n] = static_cast<char>(other[n] ^ 1);
    put(other);
    const auto files = read_stored(scratch_.path(), place, "key");
    if (files) {  // a name may be another one, but never a content
      ASSERT_EQ(files->size(), 2u) << n;
      EXPECT_EQ((*files)[0].text + (*files)[1].text, two_files[0].text + two_files[1].text) << n;
    }
  }
  EXPECT_FALSE(read_stored(scratch_.path(), {"store_001.pack", 0}, "key"));
  EXPECT_FALSE(read_stored(scratch_.path(), {"store_000.pack", 1}, "key"));
  EXPECT_FALSE(read_stored(scratch_.path(), {"store_000.pack", ~std::uint64_t{0}}, "key"));
}

TEST_F(RunStores, a_record_is_that_of_its_case_alone) {
  RunStore store(scratch_.path());
  const StoredPlace place = store.add(two_files, "key");
  EXPECT_TRUE(read_stored(scratch_.path(), place, "key"));
  for (const char* other : {"", "ke", "key.2", "another"}) EXPECT_FALSE(read_stored(scratch_.path(), place, other));
}

TEST_F(RunStores, each_process_has_a_store_of_its_own_until_it_ends) {
  RunStore mine(scratch_.path());
  const pid_t child = fork();
  if (child == 0) {
    RunStore other(scratch_.path());
    _exit(other.add({}, "key").store == "store_001.pack" ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(mine.add({}, "key").store, "store_000.pack");
  RunStore next(scratch_.path());
  EXPECT_EQ(next.add({}, "key").store, "store_001.pack") << "that of the process that has ended";
  sync_stores(scratch_.path());
}

TEST_F(RunStores, what_cannot_be_written_leaves_what_was_there) {
  RunStore store(scratch_.path());
  const StoredPlace first = store.add(two_files, "key");
  const std::string whole = text();
  rlimit limit{}, former{};
  getrlimit(RLIMIT_FSIZE, &former);
  limit = former;
  limit.rlim_cur = whole.size() + 100;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_THROW((void)store.add({{"large", std::string(1000, 'x')}}, "key"), std::runtime_error);
  setrlimit(RLIMIT_FSIZE, &former);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(text(), whole);
  EXPECT_TRUE(read_stored(scratch_.path(), first, "key"));
  EXPECT_TRUE(read_stored(scratch_.path(), store.add(two_files, "key"), "key"));
}

TEST_F(RunStores, an_unpacked_run_is_the_folder_that_it_would_have_been) {
  const records::Summary summary = sample_summary();
  const records::HistoryRow row{0.0, 0.0, 0, {1.0, 2.0, 3.0}};
  RunInMemory memory("1", {});
  RunDirectory directory(scratch_ / "run", "1", {});
  for (records::Recorder* recorder :
       {static_cast<records::Recorder*>(&memory), static_cast<records::Recorder*>(&directory)}) {
    recorder->begin(summary.header);
    recorder->row(row);
    recorder->end(summary);
  }
  StoredPlace place;
  {
    RunStore store(scratch_.path());
    place = store.add(memory.files(), "key");
  }
  const auto files = read_stored(scratch_.path(), place, "key");
  ASSERT_TRUE(files);
  EXPECT_EQ(unpack_run(*files, FolderState::good, scratch_ / "unpacked", {"run"}), scratch_ / "unpacked");
  for (const char* name : {"history.csv", "summary.json", "manifest.json"})
    EXPECT_EQ(text_of(scratch_ / "unpacked" / name), text_of(scratch_ / "run" / name)) << name;
  EXPECT_THROW((void)unpack_run({{"../out", ""}}, FolderState::good, scratch_ / "bad", {"run"}), std::runtime_error);
}

}  // namespace
}  // namespace bough::io
