#include <clocale>
#include <cstdint>
#include <cstring>
#include <locale>
#include <random>

#include "bough/io/digest.hpp"
#include "bough/io/history.hpp"
#include "bough/io/npy_history.hpp"
#include "bough/io/number_text.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

std::uint64_t bits(double value) {
  std::uint64_t word = 0;
  std::memcpy(&word, &value, sizeof word);
  return word;
}

TEST(NumberText, every_finite_double_reads_back_to_the_same_bits) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 100000; ++k) {
    const std::uint64_t word = random();
    double value = 0.0, back = 1.0;
    std::memcpy(&value, &word, sizeof value);
    if ((word >> 52u & 0x7ffu) == 0x7ffu) continue;  // infinities and NaN
    std::string text;
    append_number(text, value);
    ASSERT_TRUE(read_number(text, back)) << text;
    ASSERT_EQ(bits(value), bits(back)) << text;
  }
}

TEST(NumberText, negative_zero_keeps_its_sign) {
  std::string text;
  append_number(text, -0.0);
  double back = 1.0;
  ASSERT_TRUE(read_number(text, back));
  EXPECT_EQ(bits(-0.0), bits(back));
}

TEST(NumberText, text_that_is_not_wholly_a_number_is_refused) {
  double value = 0.0;
  for (const char* text : {"", " 1", "1 ", "1,5", "+1", "1e", "0x10", "1.0.0", "one"})
    EXPECT_FALSE(read_number(text, value)) << text;
}

TEST(History, comes_back_bit_for_bit_with_names_that_need_quotes) {
  const ScratchDirectory scratch;
  const records::HistoryHeader header{{"tip.x", "a,b.c", "quo\"te"}};
  std::vector<records::HistoryRow> rows;
  for (int k = 0; k < 50; ++k) rows.push_back({0.1 * k, 0.1 / 3.0, k, {std::sin(0.1 * k), 1e-300 / (k + 1), -0.0}});
  HistoryWriter writer(scratch / "history.csv", header);
  for (const records::HistoryRow& row : rows) writer.row(row);
  writer.commit();

  const History back = read_history(scratch / "history.csv");
  EXPECT_EQ(back.header.columns, header.columns);
  ASSERT_EQ(back.rows.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(bits(back.rows[k].time), bits(rows[k].time));
    EXPECT_EQ(bits(back.rows[k].step_size), bits(rows[k].step_size));
    EXPECT_EQ(back.rows[k].iterations, rows[k].iterations);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(bits(back.rows[k].values[c]), bits(rows[k].values[c]));
  }
}

/// A decimal comma and grouped digits, as a German locale has them, without asking the machine for one.
struct CommaNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(History, names_that_a_spreadsheet_would_take_for_formulas_are_guarded_and_come_back) {
  const ScratchDirectory scratch;
  const records::HistoryHeader header{{"=1+1", "'=x", "''@y", "-z,a", "'plain", "+", "-1"}};
  HistoryWriter writer(scratch / "history.csv", header);
  writer.commit();
  EXPECT_EQ(text_of(scratch / "history.csv"), "time,step_size,iterations,'=1+1,''=x,'''@y,\"'-z,a\",'plain,'+,-1\n");
  EXPECT_EQ(read_history(scratch / "history.csv").header.columns, header.columns);
}

TEST(History, is_the_same_under_a_locale_with_decimal_commas) {
  const ScratchDirectory scratch;
  const auto write = [&](const char* name) {
    HistoryWriter writer(scratch / name, {{"a"}});
    writer.row({1234567.25, 0.5, 12345, {-9876543.125}});
    writer.commit();
    return text_of(scratch / name);
  };
  const std::string plain = write("plain.csv");
  EXPECT_EQ(plain, "time,step_size,iterations,a\n1234567.25,0.5,12345,-9876543.125\n");
  const std::locale former = std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where the machine has it
  const std::string with_commas = write("commas.csv");
  const double back = read_history(scratch / "commas.csv").rows.at(0).values.at(0);
  std::locale::global(former);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(with_commas, plain);
  EXPECT_EQ(back, -9876543.125);
}

TEST(History, a_row_of_the_wrong_length_is_refused) {
  const ScratchDirectory scratch;
  HistoryWriter writer(scratch / "history.csv", {{"a", "b"}});
  EXPECT_THROW(writer.row({0.0, 0.0, 0, {1.0}}), std::logic_error);
}

TEST(History, a_damaged_file_is_refused_with_its_line) {
  const ScratchDirectory scratch;
  const std::string head = "time,step_size,iterations,a\n";
  const std::pair<const char*, std::string> cases[] = {
      {"", "empty file"},
      {"t,a\n", ":1: not a history"},
      {"time,step_size,iterations,\"a\n", ":1: not a history"},
  };
  for (const auto& [text, message] : cases) {
    std::ofstream(scratch / "bad.csv") << text;
    try {
      (void)read_history(scratch / "bad.csv");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  for (const char* row : {"0,0,0\n", "0,0,0,1,2\n", "0,0,-1,1\n", "0,0,0,x\n", "0,0,nan,1\n", "\n"}) {
    std::ofstream(scratch / "bad.csv") << head << "0,0,0,1\n" << row;
    try {
      (void)read_history(scratch / "bad.csv");
      ADD_FAILURE() << "accepted: " << row;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("bad.csv:3:"), std::string::npos) << error.what();
    }
  }
}

TEST(NpyHistory, a_file_cut_anywhere_keeps_its_whole_rows) {
  const ScratchDirectory scratch;
  const std::size_t rows = NpyHistoryWriter::long_history + 7;
  NpyHistoryWriter writer(scratch / "history.npy", {{"a", "b"}});
  for (std::size_t k = 0; k < rows; ++k)
    writer.row({0.5 * static_cast<double>(k), 0.5, 3, {static_cast<double>(k), -static_cast<double>(k)}});
  writer.commit();
  const std::string whole = text_of(scratch / "history.npy"), head = npy_head(rows, 5);
  EXPECT_EQ(head.size() % 64, 0u);
  ASSERT_EQ(whole.size(), head.size() + 40 * rows);
  EXPECT_EQ(whole.substr(0, head.size()), head);
  EXPECT_EQ(writer.record().hash, digest_of(whole));
  for (const std::size_t lost : {0u, 1u, 39u, 40u, 41u}) {
    const std::size_t left = rows - (lost + 39) / 40;
    const std::string cut = npy_head(0, 5) + whole.substr(head.size(), 40 * rows - lost);
    EXPECT_EQ(repaired_npy(cut, 5), npy_head(left, 5) + whole.substr(head.size(), 40 * left)) << lost;
  }
  EXPECT_EQ(repaired_npy(npy_head(0, 5) + "not a row", 5), "");
}

}  // namespace
}  // namespace bough::io
