// The journal of a batch: whole records survive whatever happens to the file, damaged ones are as if never written.
#include "bough/study/journal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "bough/io/atomic_file.hpp"
#include "support/batch_texts.hpp"
#include "support/scratch_directory.hpp"

namespace bough::study {
namespace {

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

CaseResult result_of(int k) {
  CaseResult r;
  r.which.name = std::to_string(k);
  r.status = k % 2 == 0 ? CaseStatus::ok : CaseStatus::failed;
  r.cause = "line 1\n  \"two\" \t";
  r.cost = {0.1 + k, 0.2, 3e7};
  r.report.accepted = k;
  r.report.cause = r.cause;
  r.report.measures = {{"a\n  b", 1.0 / 3.0 + k}, {"none", {}}};
  return r;
}

class Journals : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_ / "journal.jsonl"; }
  /// A journal of a few records; returns its text.
  std::string made(int count) {
    Journal journal(file(), false);
    for (int k = 0; k < count; ++k) journal.add("key" + std::to_string(k), result_of(k));
    return text_of_file(file());
  }
  support::ScratchDirectory folder_;
};

TEST_F(Journals, records_come_back_with_all_their_bits) {
  (void)made(5);
  const Journal journal(file(), true);
  ASSERT_EQ(journal.records().size(), 5u);
  for (int k = 0; k < 5; ++k) {
    std::optional<CaseResult> r = journal.records().find("key" + std::to_string(k));
    ASSERT_TRUE(r);
    const CaseResult original = result_of(k);
    r->which = original.which;
    EXPECT_EQ(support::batch_csv({*r}), support::batch_csv({original}));
    EXPECT_EQ(support::cost_csv({*r}), support::cost_csv({original}));
    EXPECT_EQ(r->report.measures[0].value, original.report.measures[0].value);
  }
  EXPECT_FALSE(journal.records().find("other"));
}

TEST_F(Journals, a_file_cut_off_anywhere_keeps_the_records_before) {
  const std::string text = made(3);
  for (std::size_t n = 0; n <= text.size(); n += 53) {
    io::write_file(file(), text.substr(0, n));
    const auto whole =
        static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(n), '\n'));
    {
      Journal journal(file(), true);
      EXPECT_EQ(journal.records().size(), whole) << n;
      journal.add("more", result_of(9));  // goes on behind the last whole record
    }
    const Journal again(file(), true);
    EXPECT_EQ(again.records().size(), whole + 1) << n;
  }
}

TEST_F(Journals, a_byte_that_changed_costs_one_record_at_most) {
  const std::string text = made(3);
  for (std::size_t n = 0; n < text.size(); n += 61) {
    std::string damaged = text;
    damaged[n] = static_cast<char>(damaged[n] ^ 1);
    io::write_file(file(), damaged);
    const Journal journal(file(), true);
    EXPECT_GE(journal.records().size(), 1u) << n;  // a line end that changed joins two records
    EXPECT_LE(journal.records().size(), 2u) << n;
  }
}

TEST_F(Journals, of_two_records_with_one_key_the_last_counts) {
  {
    Journal journal(file(), false);
    for (const int k : {1, 2}) journal.add("key", result_of(k));
  }
  const Records records = read_records(file());
  EXPECT_EQ(records.size(), 1u);
  EXPECT_EQ(records.find("key")->report.accepted, 2);
  std::vector<std::string> names;
  for_each_record(file(), [&](const auto&, const CaseResult& r, const auto&) { names.push_back(r.which.name); });
  EXPECT_EQ(names, (std::vector<std::string>{"1", "2"}));
}

TEST_F(Journals, a_new_batch_starts_empty) {
  (void)made(3);
  const Journal journal(file(), false);
  EXPECT_EQ(journal.records().size(), 0u);
  EXPECT_TRUE(text_of_file(file()).empty());
}

TEST_F(Journals, a_case_is_its_content) {
  const std::vector<std::string> two = {"/x=1", "/y=2"}, one = {"/x=1/y=2"}, other = {"/x=1", "/y=3"};
  EXPECT_EQ(key_of("{}", two), key_of("{}", two));
  EXPECT_NE(key_of("{}", two), key_of("{ }", two));
  EXPECT_NE(key_of("{}", two), key_of("{}", one));
  EXPECT_NE(key_of("{}", two), key_of("{}", other));
  EXPECT_NE(key_of("{}", two), key_of("{}"));
}

}  // namespace
}  // namespace bough::study
