// Values of random formulas against muParser, an independent reader of the same language.

#include <gtest/gtest.h>
#include <muParser.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "bough/laws/make_law.hpp"

namespace bough::laws {
namespace {

/// Small generator of random numbers (splitmix64), the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  int below(int n) {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<int>((z ^ (z >> 31U)) % static_cast<std::uint64_t>(n));
  }

 private:
  std::uint64_t state_;
};

std::string make_text(Random& random, int depth) {
  if (depth == 0 || random.below(8) == 0) {
    switch (random.below(5)) {
      case 0:
        return "pi";
      case 1:
        return "e";
      case 2:
        return std::to_string(random.below(400)).append("e-2");
      default:
        return "t";
    }
  }
  const auto part = [&] { return make_text(random, depth - 1); };
  static const char* const unary[] = {"sin",  "cos", "tan", "asin", "acos", "atan", "sinh", "cosh",
                                      "tanh", "exp", "log", "sqrt", "abs",  "sign", "step", "-"};
  static const char* const binary[] = {"+", "-", "*", "/", "^"};
  const int kind = random.below(5);
  const std::string a = part();
  if (kind == 0) return std::string(unary[random.below(16)]).append("(").append(a).append(")");
  if (kind == 1) return std::string("pow(").append(a).append(", ").append(std::to_string(random.below(4))).append(")");
  const std::string b = part();
  if (kind == 2) return std::string(random.below(2) == 0 ? "min(" : "max(").append(a).append(",").append(b).append(")");
  if (kind == 3) return std::string("(").append(a).append(binary[random.below(5)]).append(b).append(")");
  return std::string(a).append(" ").append(binary[random.below(4)]).append(" ").append(b);  // precedence to the reader
}

// muParser's own min, max and sign swallow a part that is no number; a law reports it.
double min_value(double x, double y) { return std::isnan(x) || std::isnan(y) ? x + y : std::fmin(x, y); }
double max_value(double x, double y) { return std::isnan(x) || std::isnan(y) ? x + y : std::fmax(x, y); }
double sign_value(double x) { return x < 0.0 ? -1.0 : (x > 0.0 ? 1.0 : x); }
double step_value(double x) { return x < 0.0 ? 0.0 : (x >= 0.0 ? 1.0 : x); }
double pow_value(double x, double y) { return std::pow(x, y); }
double log_value(double x) { return std::log(x); }
double sqrt_value(double x) { return std::sqrt(x); }

TEST(MuParser, values_of_random_formulas_agree) {
  Random random(20240607);
  int num_compared = 0;
  int num_varying = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string text = make_text(random, 2 + i % 4);
    SCOPED_TRACE(text);
    double t = 0.0;
    mu::Parser parser;
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    parser.DefineVar("t", &t);
    parser.DefineFun("min", min_value);
    parser.DefineFun("max", max_value);
    parser.DefineFun("sign", sign_value);
    parser.DefineFun("step", step_value);
    parser.DefineFun("pow", pow_value);
    parser.DefineFun("log", log_value);
    parser.DefineFun("sqrt", sqrt_value);
    parser.SetExpr(text);
    const Law law = make_expression(text);
    for (double time : {0.3, 0.95, 1.7, -0.6}) {
      t = time;
      const double expected = parser.Eval();
      const LawValue found = law.at(time);
      if (!std::isfinite(expected)) {
        EXPECT_FALSE(std::isfinite(found.value));
        continue;
      }
      // Both take the same operations of the C library; muParser may gather constants and write small powers as
      // products, and a formula may magnify that: by its rate for a change of t of one eps, and by a factor for steep
      // parts that cancel.
      const double scale = 1.0 + std::abs(expected) + (std::isfinite(found.rate) ? std::abs(found.rate) : 0.0);
      EXPECT_NEAR(found.value, expected, 1e-12 * scale) << "t = " << time;
      ++num_compared;
      if (!law.is_constant()) ++num_varying;
    }
  }
  EXPECT_GT(num_compared, 1500);
  EXPECT_GT(num_varying, 800);
}

}  // namespace
}  // namespace bough::laws
