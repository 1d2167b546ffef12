/// Numbers with what is known of them, and what a run writes of measured errors.
#include <gtest/gtest.h>

#include <cmath>

#include "bough/io/columns.hpp"
#include "bough/io/history.hpp"
#include "bough/io/known_text.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/records/errors.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

TEST(KnownText, digits_are_cut_where_the_error_begins) {
  EXPECT_EQ(known_text(0.335228, 4e-5), "0.33523 +- 4e-05");
  EXPECT_EQ(known_text(0.335228, 3.1e-5), "0.33523 +- 4e-05") << "errors are rounded up";
  EXPECT_EQ(known_text(0.335228, 9.9e-5), "0.3352 +- 0.0001");
  EXPECT_EQ(known_text(-123456.7, 30.0), "-123460 +- 30");
  EXPECT_EQ(known_text(2.5, 0.5), "2.5 +- 0.5");
  EXPECT_EQ(known_text(1e-3, 4e-2), "0 +- 0.04");
  EXPECT_EQ(known_text(1.23456e-9, 2e-12), "1.235e-09 +- 2e-12");
  EXPECT_EQ(known_text(0.25, 0.0), "0.25");
  EXPECT_EQ(known_text(0.335228, std::nan("")), "0.335 +- ?");
}

TEST(MeasuredErrors, stand_beside_the_history_with_their_columns_and_in_the_summary) {
  const ScratchDirectory scratch;
  records::Summary summary;
  summary.status = records::RunStatus::ok;
  summary.header.columns = {"tip.x"};
  summary.header.about = {{"m", "position", "tip"}};
  auto errors = std::make_shared<records::MeasuredErrors>();
  errors->header.columns = {"tip.x.extrapolated", "tip.x.error_in_time", "tip.x.error_of_mesh"};
  errors->header.about = {3, {"m", "position", "tip"}};
  errors->rows = {{0.5, 0.1, 2, {1.5, 0.25, std::nan("")}}};
  records::ErrorOf of;
  of.name = "tip.x";
  of.value = 1.25;
  of.extrapolated = 1.5;
  of.time.state = records::ErrorState::resolved;
  of.time.largest = 0.25;
  of.mesh.state = records::ErrorState::not_resolved;
  of.mesh.cause = "beam 'arm' has too few elements";
  errors->columns = {of};
  summary.errors = errors;
  RunDirectory directory(scratch / "run", "0");
  directory.begin(summary.header);
  directory.row({0.5, 0.1, 2, {1.25}});
  directory.end(summary);
  History read = read_history(scratch / "run" / "errors.csv");
  EXPECT_EQ(read.header.columns, errors->header.columns);
  ASSERT_EQ(read.rows.size(), 1u);
  EXPECT_EQ(read.rows[0].values[1], 0.25);
  EXPECT_TRUE(std::isnan(read.rows[0].values[2]));
  History history = read_history(scratch / "run" / "history.csv");
  read_columns(scratch / "run" / "columns.json", history.header);
  EXPECT_EQ(history.header.about.at(0).unit, "m") << "the columns of errors do not disturb those of the history";
  EXPECT_NE(text_of(scratch / "run" / "columns.json").find("tip.x.error_of_mesh"), std::string::npos);
  const std::string text = text_of(scratch / "run" / "summary.json");
  for (const char* part : {"\"errors\"", "\"resolved\"", "\"not resolved\"", "beam 'arm' has too few elements"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_NO_THROW((void)read_whole_summary(scratch / "run", {"errors.csv"}));
}

}  // namespace
}  // namespace bough::io
