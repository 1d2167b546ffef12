// Recursive descent over
//   sum     = product { (+|-) product }
//   product = signed { (*|/) signed }
//   signed  = { +|- } power
//   power   = atom [ ^ signed ]
//   atom    = number | t | pi | e | name ( sum { , sum } ) | ( sum )

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <system_error>

#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"
#include "eval_program.hpp"
#include "program.hpp"

namespace bough::laws {

namespace {

struct FunctionName {
  std::string_view name;
  Op op;
};

constexpr std::array<FunctionName, 18> functions{{{"sin", Op::sin},
                                                  {"cos", Op::cos},
                                                  {"tan", Op::tan},
                                                  {"asin", Op::asin},
                                                  {"acos", Op::acos},
                                                  {"atan", Op::atan},
                                                  {"sinh", Op::sinh},
                                                  {"cosh", Op::cosh},
                                                  {"tanh", Op::tanh},
                                                  {"exp", Op::exp},
                                                  {"log", Op::log},
                                                  {"sqrt", Op::sqrt},
                                                  {"abs", Op::abs},
                                                  {"sign", Op::sign},
                                                  {"step", Op::step},
                                                  {"min", Op::min},
                                                  {"max", Op::max},
                                                  {"pow", Op::pow_general}}};
constexpr std::array<std::string_view, 3> symbols{"t", "pi", "e"};

/// Least number of letters inserted, removed or replaced that turns a into b (Levenshtein).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min(replaced, std::min(row[j], row[j + 1]) + 1);
    }
  }
  return row[b.size()];
}

/// The known name nearest to one that is not known, empty where none is near (more than two letters or half of it off).
std::string_view nearest_name(std::string_view unknown, std::span<const std::string> variables) {
  std::string_view best;
  std::size_t least = std::min<std::size_t>(2, (unknown.size() + 1) / 2) + 1;
  const auto offer = [&](std::string_view name) {
    const std::size_t d = distance(unknown.substr(0, 32), name);
    if (d < least) {
      least = d;
      best = name;
    }
  };
  for (const FunctionName& f : functions) offer(f.name);
  for (std::string_view name : symbols) offer(name);
  for (std::string_view name : variables) offer(name);
  return best;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

class Parser {
 public:
  Parser(const std::string& text, std::span<const std::string> variables) : text_(text), variables_(variables) {}

  Program run() {
    skip_space();
    if (at_end()) fail(at_, "the formula is empty");
    parse_sum();
    if (!at_end()) fail(at_, peek() == ')' ? "a ')' without a '('" : "expected an operator, found " + found());
    return std::move(program_);
  }

 private:
  /// Counts the levels of nesting during its lifetime.
  class Level {
   public:
    explicit Level(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > max_nesting) {
        parser_.fail(parser_.at_, "nested deeper than " + std::to_string(max_nesting) + " levels");
      }
    }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    ~Level() { --parser_.depth_; }

   private:
    Parser& parser_;
  };

  [[noreturn]] void fail(std::size_t position, const std::string& rule) const {
    throw LawError(text_, position, "formula, position " + std::to_string(position) + ": " + rule);
  }

  bool at_end() const { return at_ >= text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  std::string found() const { return at_end() ? std::string("the end") : std::string("'") + peek() + "'"; }

  void skip_space() {
    while (!at_end() && (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r')) ++at_;
  }
  bool accept(char c) {
    if (at_end() || peek() != c) return false;
    ++at_;
    skip_space();
    return true;
  }

  std::uint32_t here() const { return static_cast<std::uint32_t>(program_.code.size()); }
  bool is_number(std::size_t from_end) const {
    const std::vector<Instruction>& code = program_.code;
    return code.size() >= from_end && code[code.size() - from_end].op == Op::number;
  }

  void emit_leaf(Op op, double number, std::uint32_t which = 0) {
    if (++height_ > max_stack) fail(at_, "too many unfinished terms");
    program_.code.push_back({op, number, which});
  }

  /// Adds an operation on the last one or two results; `first` is where the instructions of its arguments begin.
  void emit(Op op, std::uint32_t first) {
    std::vector<Instruction>& code = program_.code;
    if (has_two_arguments(op)) {
      --height_;
      if (op == Op::pow_general && is_number(1) && !is_number(2)) {
        const double exponent = code.back().number;
        code.back() = {Op::pow_number, exponent, 0};
        return;
      }
      if (is_number(1) && is_number(2)) {
        fold(op, 2);
        return;
      }
    } else if (is_number(1)) {
      fold(op, 1);
      return;
    }
    code.push_back({op, 0.0, first});
    program_.has_switch = program_.has_switch || is_switch(op);
  }

  /// Replaces an operation on numbers by its result.
  void fold(Op op, std::size_t num_arguments) {
    std::vector<Instruction>& code = program_.code;
    Program part;
    part.code.assign(code.end() - static_cast<std::ptrdiff_t>(num_arguments), code.end());
    part.code.push_back({op, 0.0, 0});
    code.resize(code.size() - num_arguments);
    code.push_back({Op::number, eval_program(part, 0.0, Side::right).value, 0});
  }

  void parse_sum() {
    const std::uint32_t first = here();
    parse_product();
    for (;;) {
      if (accept('+')) {
        parse_product();
        emit(Op::add, first);
      } else if (accept('-')) {
        parse_product();
        emit(Op::subtract, first);
      } else {
        return;
      }
    }
  }

  void parse_product() {
    const std::uint32_t first = here();
    parse_signed();
    for (;;) {
      if (accept('*')) {
        parse_signed();
        emit(Op::multiply, first);
      } else if (accept('/')) {
        parse_signed();
        emit(Op::divide, first);
      } else {
        return;
      }
    }
  }

  void parse_signed() {
    const std::uint32_t first = here();
    bool is_negative = false;
    while (peek() == '-' || peek() == '+') {
      is_negative = is_negative != (peek() == '-');
      accept(peek());
    }
    const Level level(*this);
    parse_atom();
    if (accept('^')) {
      parse_signed();
      emit(Op::pow_general, first);
    }
    if (is_negative) emit(Op::negate, first);
  }

  void parse_atom() {
    if (is_digit(peek()) || peek() == '.') return parse_number();
    if (is_letter(peek())) return parse_name();
    const std::size_t opened = at_;
    if (!accept('(')) fail(at_, "expected a number, a name or '(', found " + found());
    parse_sum();
    close(opened);
  }

  void close(std::size_t opened) {
    if (accept(')')) return;
    if (at_end()) fail(at_, "the '(' at position " + std::to_string(opened) + " is not closed");
    fail(at_, "expected an operator or ')', found " + found());
  }

  void parse_number() {
    double number = 0.0;
    const char* begin = text_.data() + at_;
    const auto [end, status] = std::from_chars(begin, text_.data() + text_.size(), number);
    if (status == std::errc::result_out_of_range) fail(at_, "the number is out of range");
    if (status != std::errc{}) fail(at_, "expected a number, found " + found());
    at_ += static_cast<std::size_t>(end - begin);
    skip_space();
    emit_leaf(Op::number, number);
  }

  void parse_name() {
    const std::size_t begin = at_;
    while (!at_end() && (is_letter(peek()) || is_digit(peek()))) ++at_;
    const std::string_view name = std::string_view(text_).substr(begin, at_ - begin);
    skip_space();
    if (name == "t") return emit_leaf(Op::time, 0.0);
    if (name == "pi") return emit_leaf(Op::number, std::numbers::pi);
    if (name == "e") return emit_leaf(Op::number, std::numbers::e);
    for (const FunctionName& f : functions) {
      if (f.name == name) return parse_call(f);
    }
    const auto variable = std::find(variables_.begin(), variables_.end(), name);
    if (variable != variables_.end())
      return emit_leaf(Op::variable, 0.0, static_cast<std::uint32_t>(variable - variables_.begin()));
    const std::string_view near = nearest_name(name, variables_);
    fail(begin, "unknown name '" + std::string(name) + "'" +
                    (near.empty() ? "" : ", did you mean '" + std::string(near) + "'?"));
  }

  void parse_call(const FunctionName& f) {
    const std::size_t opened = at_;
    const std::uint32_t first = here();
    if (!accept('(')) fail(at_, "expected '(' after " + std::string(f.name) + ", found " + found());
    const std::size_t least = has_two_arguments(f.op) ? 2 : 1;
    const bool takes_more = f.op == Op::min || f.op == Op::max;
    parse_sum();
    std::size_t num_arguments = 1;
    std::vector<std::uint32_t> open = {first};  // where the groups of arguments begin that are not joined yet
    const auto join = [&] {
      open.pop_back();
      emit(f.op, open.back());
    };
    for (std::size_t comma = at_; accept(','); comma = at_) {
      if (num_arguments == least && !takes_more) fail(comma, std::string(f.name) + " takes " + count(least));
      open.push_back(here());
      parse_sum();
      ++num_arguments;
      // Equal numbers of arguments are joined, as in a balanced tree: in a chain the last of n operations would have
      // n - 1 of them in its argument, and to search all arguments for changes of sign would take n^2 steps.
      if (least == 2)
        for (std::size_t pairs = num_arguments; pairs % 2 == 0; pairs /= 2) join();
    }
    if (peek() == ')' && num_arguments < least) {
      fail(at_, std::string(f.name) + " takes " + count(least) + (takes_more ? " or more" : ""));
    }
    close(opened);
    if (least == 1) emit(f.op, first);
    while (open.size() > 1) join();
  }

  static std::string count(std::size_t n) { return n == 1 ? "one argument" : "two arguments"; }

  const std::string& text_;
  std::span<const std::string> variables_;
  std::size_t at_ = 0;
  int depth_ = 0;
  int height_ = 0;
  Program program_;
};

}  // namespace

Program parse_formula(const std::string& text, std::span<const std::string> variables) {
  return Parser(text, variables).run();
}

const std::vector<std::string>& formula_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all(symbols.begin(), symbols.end());
    for (const FunctionName& f : functions) all.emplace_back(f.name);
    return all;
  }();
  return words;
}

}  // namespace bough::laws
