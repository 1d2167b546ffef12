// Formulas that files ask numbers of: names, constants, values by name.
#include "bough/laws/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bough/laws/law_error.hpp"
#include "bough/laws/make_law.hpp"

namespace bough::laws {
namespace {

std::string names_of(const std::string& formula) {
  std::string all;
  for (const NamePlace& place : names_in(formula)) all += formula.substr(place.position, place.length) + " ";
  return all;
}

TEST(Formula, names_end_where_the_reader_ends_them) {
  EXPECT_EQ(names_of("2*length + sin(a_1)"), "length sin a_1 ");
  EXPECT_EQ(names_of("1e3 + 2e + 3ex"), "e ex ");
  EXPECT_EQ(names_of(".5a. .b 1..c"), "a b c ");
  EXPECT_EQ(names_of("\xC3\xA9 )(("), "");
}

TEST(Formula, constants_are_those_of_laws) {
  for (const std::string text :
       {"2^-3^2", "pow(2, 0.5)", "min(1, max(2, 3), 0.5)", "sin(1)/cos(1)", "-(3)^3", "step(-1)"})
    EXPECT_EQ(eval_constant(text), make_expression(text).at(0.0).value) << text;
  EXPECT_EQ(eval_constant("1/0"), HUGE_VAL);
  EXPECT_TRUE(std::isnan(eval_constant("0/0")));
}

TEST(Formula, a_constant_has_no_t) {
  try {
    (void)eval_constant("1 + 2*t");
    FAIL();
  } catch (const LawError& e) {
    EXPECT_EQ(e.position, 6u);
  }
}

TEST(Formula, values_come_by_name) {
  const std::vector<std::string> names = {"x", "y"};
  const Formula f("abs(x) - y^2*max(x, y) + pi", names);
  for (const double x : {-2.0, 0.5})
    for (const double y : {-1.0, 3.0}) {
      const std::vector<double> values = {x, y};
      EXPECT_DOUBLE_EQ(f(values), std::abs(x) - y * y * std::max(x, y) + std::acos(-1.0));
    }
  try {
    Formula("x + yy", names);
    FAIL();
  } catch (const LawError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'y'"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace bough::laws
