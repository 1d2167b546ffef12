// Shards: which cases a part of a batch has, where its number is found, and how parts are put together again.
#include "bough/study/shards.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>

#include "bough/io/digest.hpp"
#include "bough/study/collect.hpp"
#include "bough/study/job_files.hpp"
#include "support/batch_texts.hpp"
#include "support/scratch_directory.hpp"

namespace bough::study {
namespace {

using Variables = std::map<std::string, std::string>;

Shard read(const std::string& text, const Variables& variables = {}) {
  return read_shard(text, [&](const char* name) {
    const auto at = variables.find(name);
    return at == variables.end() ? nullptr : at->second.c_str();
  });
}

Variables slurm(const std::string& id, const std::string& first, const std::string& last, const std::string& count) {
  return {{"SLURM_ARRAY_TASK_ID", id},
          {"SLURM_ARRAY_TASK_MIN", first},
          {"SLURM_ARRAY_TASK_MAX", last},
          {"SLURM_ARRAY_TASK_COUNT", count}};
}

TEST(Shards, numbers_are_taken_as_given_or_from_one_engine) {
  EXPECT_EQ(folder_name(read("3/20")), "shard_003_of_020");
  EXPECT_EQ(read("auto", slurm("4", "1", "4", "4")).number, 4u);
  EXPECT_EQ(read("auto", slurm("0", "0", "3", "4")).number, 1u);
  EXPECT_EQ(read("auto/4", slurm("2", "1", "4", "4")).count, 4u);
  EXPECT_EQ(read("auto", {{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "3"}}).number, 3u);
  const Shard indexed = read("auto/9", {{"JOB_COMPLETION_INDEX", "8"}});
  EXPECT_EQ(indexed.number, 9u);
  EXPECT_EQ(indexed.origin, "JOB_COMPLETION_INDEX");
}

TEST(Shards, what_is_not_known_for_sure_is_refused) {
  for (const char* text : {"", "/", "1", "0/3", "4/3", "1/0", "-1/3", "1/3/3", "1.0/3", "auto/x", "auto/", "auto/0",
                           "9999999999/99999999999", " 1/3", "automatic"})
    EXPECT_THROW((void)read(text), std::runtime_error) << text;
  EXPECT_THROW((void)read("auto"), std::runtime_error);
  EXPECT_THROW((void)read("auto", {{"JOB_COMPLETION_INDEX", "0"}}), std::runtime_error);
  EXPECT_THROW((void)read("auto/3", {{"JOB_COMPLETION_INDEX", "3"}}), std::runtime_error);
  EXPECT_THROW((void)read("auto", {{"OMPI_COMM_WORLD_RANK", "0"}}), std::runtime_error);
  EXPECT_THROW((void)read("auto", {{"SLURM_ARRAY_TASK_ID", "1"}}), std::runtime_error);
  EXPECT_THROW((void)read("auto", slurm("7", "7", "7", "1")), std::runtime_error) << "a task that is run again";
  EXPECT_THROW((void)read("auto", slurm("1", "1", "9", "3")), std::runtime_error) << "an array with gaps";
  EXPECT_THROW((void)read("auto/5", slurm("1", "1", "4", "4")), std::runtime_error) << "another number of tasks";
  Variables both = slurm("1", "1", "4", "4");
  both["OMPI_COMM_WORLD_RANK"] = "0";
  EXPECT_THROW((void)read("auto", both), std::runtime_error);
}

TEST(Shards, every_case_is_in_one_of_them_and_their_work_is_nearly_equal) {
  std::vector<double> work;
  for (int k = 0; k < 1000; ++k) work.push_back(1.0 + 997 * k % 100);
  for (const std::size_t count : {1u, 2u, 7u, 64u}) {
    const std::vector<std::size_t> shards = shards_of(work, count);
    ASSERT_EQ(shards.size(), work.size());
    std::vector<double> loads(count, 0.0);
    for (std::size_t i = 0; i < work.size(); ++i) loads.at(shards[i]) += work[i];
    const auto [least, most] = std::minmax_element(loads.begin(), loads.end());
    EXPECT_LE(*most - *least, 100.0) << "greedy: apart by no more than one case";
  }
  const std::vector<std::size_t> alike = shards_of(std::vector<double>(10, 0.0), 4);
  for (std::size_t s = 0; s < 4; ++s) EXPECT_GE(std::count(alike.begin(), alike.end(), s), 2) << "cases of no work";
  EXPECT_EQ(shards_of({}, 3).size(), 0u);
}

TEST(Shards, work_is_looked_at_once_for_what_decides_it) {
  std::vector<std::vector<io::SweepValue>> rows;
  for (int n = 1; n <= 4; ++n)
    for (int k = 0; k < 250; ++k)
      rows.push_back({{std::to_string(n), 1.0 * n}, {std::to_string(0.001 * k), 0.001 * k}, {"\"word\"", {}}});
  int looks = 0;
  const std::vector<double> work = predicted_work(
      rows.size(), [&rows](std::size_t i) { return rows[i]; },
      [&](const std::vector<io::SweepValue>& row) {
        ++looks;
        return 10.0 * std::stod(row[0].text);
      });
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(work[i], 10.0 * static_cast<double>(i / 250 + 1));
  EXPECT_LE(looks, 50);
}

TEST(JobFiles, words_reach_the_program_as_they_are) {
  EXPECT_EQ(shell_quoted("plain/name.json"), "plain/name.json");
  EXPECT_EQ(shell_quoted("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_quoted(""), "''");
  JobSpec spec{"/bin/bough", {"sweep", "/a b/it's.json"}, "/a b/out", "out", "/a b", 3, 1, 1e8};
  EXPECT_NE(job_file(JobEngine::slurm, spec).text.find("#SBATCH --array=1-3\n"), std::string::npos);
  EXPECT_NE(job_file(JobEngine::slurm, spec).text.find("--shard \"${SLURM_ARRAY_TASK_ID}/3\"\n"), std::string::npos);
  EXPECT_NE(job_file(JobEngine::parallel, spec).text.find("'/a b/it'\\''s.json' --shard 2/3\n"), std::string::npos);
  EXPECT_NE(job_file(JobEngine::snakemake, spec).text.find(" --shard 3/3\",\n"), std::string::npos);
  spec.words[1] = "/a b/$(JOB_COMPLETION_INDEX)";
  EXPECT_NE(job_file(JobEngine::kubernetes, spec).text.find("\"/a b/$$(JOB_COMPLETION_INDEX)\""), std::string::npos);
  spec.common_folder = "/";
  EXPECT_THROW((void)job_file(JobEngine::kubernetes, spec), std::runtime_error);
  spec.words[1] = "two\nlines";
  EXPECT_THROW((void)job_file(JobEngine::slurm, spec), std::runtime_error);
}

SweepCases two_cases(const std::string& second = "b") {
  SweepCases cases({"a", second});
  cases.add({{"0.123456789012", 0.123456789012}, {"[1, 2]", {}}});
  cases.add({{"2", 2.0}, {"\"x,y\"", {}}});
  return cases;
}

TEST(CaseLists, values_are_those_of_the_list_and_what_differs_is_told) {
  const std::string list = cases_csv(two_cases());
  SweepCases same = two_cases();
  EXPECT_EQ(adopt_cases(list, same), "");
  EXPECT_EQ(cases_csv(same), list);
  SweepCases drawn = two_cases();  // by a library whose last digit is another
  drawn.set(0, 0, {"0.123456789013", 0.123456789013});
  EXPECT_EQ(adopt_cases(list, drawn), "");
  EXPECT_EQ(cases_csv(drawn), list);
  SweepCases other = two_cases();
  other.set(0, 0, {"0.1234567", 0.1234567});
  EXPECT_NE(adopt_cases(list, other), "");
  other = two_cases();
  other.set(1, 1, {"\"x\"", {}});
  EXPECT_NE(adopt_cases(list, other), "");
  other = SweepCases({"a", "b"});
  other.add(two_cases().at(0).inputs);
  EXPECT_NE(adopt_cases(list, other), "");
  other = two_cases("c");
  EXPECT_NE(adopt_cases(list, other), "");
  EXPECT_NE(adopt_cases("", other), "");
}

/// Shards of four cases, written as a batch writes them.
class Collections : public testing::Test {
 protected:
  void write(const std::filesystem::path& file, const std::string& text) const {
    std::filesystem::create_directories((folder_ / file.string()).parent_path());
    std::ofstream(folder_ / file.string(), std::ios::binary) << text;
  }
  void make_shard(std::size_t number, std::size_t count, const std::vector<int>& cases, double value = 1.0,
                  const std::string& library = "same") const {
    const std::string name = folder_name({number, count, ""});
    ShardRecord record{
        "batch", "title", "/scenes", io::digest_of(list_), "content", {number, count, "here"}, {"p", "i", library}};
    write(name + "/" + shard_file, shard_text(record));
    std::vector<BatchCase> own;
    std::vector<std::string> keys;
    Journal journal(folder_ / name / journal_file, false);
    for (const int k : cases) {
      own.push_back({"case " + std::to_string(k), "", ""});
      keys.push_back("key" + std::to_string(k));
      CaseResult result;
      result.which = own.back();
      result.status = CaseStatus::ok;
      result.report.measures = {{"m", value + k}};
      journal.add(keys.back(), result);
    }
    write(name + "/" + keys_file, keys_csv(CaseList(own), keys));
  }
  std::string list_ = "case\ncase 1\ncase 2\ncase 3\ncase 4\n";
  support::ScratchDirectory folder_;
};

TEST_F(Collections, rows_of_any_mixture_of_partitions_are_found_by_case) {
  write(cases_file, list_);
  make_shard(1, 2, {4, 1});
  make_shard(2, 3, {1, 2});
  Collected all = collect_shards({folder_.path()});
  EXPECT_EQ(all.missing, std::vector<std::string>{"case 3"});
  make_shard(1, 1, {1, 2, 3, 4});
  all = collect_shards({folder_ / "shard_001_of_001", folder_ / "shard_001_of_002", folder_ / "shard_002_of_003"});
  EXPECT_TRUE(all.missing.empty());
  ASSERT_EQ(all.results.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(all.results[k].report.measures.at(0).value, 2.0 + static_cast<double>(k));
  EXPECT_TRUE(all.machines.empty());
}

TEST_F(Collections, rows_of_other_arithmetic_are_marked) {
  write(cases_file, list_);
  make_shard(1, 2, {1, 2});
  make_shard(2, 2, {3, 4}, 1.0, "another");
  const Collected all = collect_shards({folder_.path()});
  EXPECT_EQ(all.machines.size(), 2u);
  const std::string table = support::text_of([&](const io::TextSink& sink) {
    write_batch_csv(all.results, sink, [&](std::size_t i) { return all.machine_of_case(i); });
  });
  EXPECT_NE(table.find(",m,machine\n"), std::string::npos);
  EXPECT_NE(table.find(",2,i same\n"), std::string::npos);
  EXPECT_NE(table.find(",5,i another\n"), std::string::npos);
}

TEST_F(Collections, what_does_not_belong_together_is_refused) {
  EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << "no shard";
  make_shard(1, 2, {1, 2});
  EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << "no list";
  write(cases_file, list_ + "case 5\n");
  EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << "another list";
  write(cases_file, list_);
  make_shard(2, 2, {2, 3}, 7.0);
  EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << "two rows of one case that differ";
  make_shard(2, 2, {9});
  EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << "a case that is not in the list";
  make_shard(2, 2, {3});
  EXPECT_EQ(collect_shards({folder_.path()}).results.size(), 4u);
  write(std::string("shard_002_of_002/") + keys_file, "case\ncase 3\n");
  EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << "no keys";
  make_shard(2, 2, {3});
  for (const char* text : {"", "{}", "[]", "{\"format\": \"bough shard 1\"}",
                           "{\"format\": \"bough shard 1\", \"number\": 3, \"count\": 2}"}) {
    write(std::string("shard_002_of_002/") + shard_file, text);
    EXPECT_THROW((void)collect_shards({folder_.path()}), std::runtime_error) << text;
  }
}

}  // namespace
}  // namespace bough::study
