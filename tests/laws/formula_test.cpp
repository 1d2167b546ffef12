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

std::string unit(const std::string& formula) {
  const std::vector<std::string> names = {"x", "y", "v", "f", "a", "n"}, units = {"m", "m", "m/s", "N", "rad", ""};
  return Formula(formula, names).unit(units);
}

TEST(Formula, units_follow_from_those_of_the_variables) {
  EXPECT_EQ(unit("x"), "m");
  EXPECT_EQ(unit("0.9 - max(x - 1e3*step(v + 8), -y)"), "m");
  EXPECT_EQ(unit("sqrt(x^2 + y^2)"), "m");
  EXPECT_EQ(unit("sqrt(x*x + y*y)"), "m");
  EXPECT_EQ(unit("v*v"), "(m/s)^2");
  EXPECT_EQ(unit("f^0.5"), "N^0.5");
  EXPECT_EQ(unit("1/x"), "");  // the 1 may have a unit
  EXPECT_EQ(unit("n/x"), "m^-1");
  EXPECT_EQ(unit("x/y"), "");
  EXPECT_EQ(unit("x/y*v"), "m/s");
  EXPECT_EQ(unit("n*x + sin(a)*y"), "m");
  EXPECT_EQ(unit("atan(x/y)"), "rad");
  EXPECT_EQ(unit("abs(a) - 0.1"), "rad");
  EXPECT_EQ(unit("step(x)*step(y)"), "");
}

TEST(Formula, a_unit_that_does_not_follow_is_not_told) {
  for (const char* formula : {"2*x", "x + v", "x*f", "x + 9.81*n*v", "x^n", "min(x, f)", "3", "x + x^2"})
    EXPECT_EQ(unit(formula), "") << formula;
}

// What has an unknown unit is taken as a number is: it has the unit of the other side of a sum.
TEST(Formula, units_follow_where_some_of_them_are_not_known) {
  const std::vector<std::string> names = {"x", "a", "n"};
  const std::vector<std::optional<std::string>> units = {"m", std::nullopt, ""};
  const auto known = [&](const std::string& formula) {
    return Formula(formula, names).unit_if_known(units).value_or("?");
  };
  EXPECT_EQ(known("x - a"), "m");
  EXPECT_EQ(known("n*x"), "m");
  EXPECT_EQ(known("x/x"), "");
  EXPECT_EQ(known("sin(a)"), "");
  for (const char* formula : {"a", "a*x", "a*n", "x + a^2*x", "3", "sqrt(a)"})
    EXPECT_EQ(known(formula), "?") << formula;
}

TEST(Formula, what_is_always_0_or_1_is_found_by_its_form) {
  const std::vector<std::string> names = {"x", "y"};
  for (const char* formula : {"step(x)", "step(x - 1)*step(2 - x)", "1 - step(x)", "max(step(x), step(y), 0)", "1",
                              "min(1, step(x)^2)", "abs(1 - step(y))"})
    EXPECT_TRUE(Formula(formula, names).is_zero_or_one()) << formula;
  for (const char* formula : {"x", "step(x) + step(y)", "2*step(x)", "sign(x)", "step(x) - 1", "0.5", "step(x)^-1",
                              "step(x)/step(y)", "1 - x", "max(step(x), y)"})
    EXPECT_FALSE(Formula(formula, names).is_zero_or_one()) << formula;
}

}  // namespace
}  // namespace bough::laws
