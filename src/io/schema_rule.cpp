#include "bough/io/schema_rule.hpp"

namespace bough::io {

const Rule& RuleTable::resolve(const Rule& rule) const {
  const Rule* r = &rule;
  while (r->form == Form::named) r = named.at(r->target).get();
  return *r;
}

std::string name_fault(const std::string& name) {
  if (name.empty()) return "a name has at least one character";
  std::size_t count = 0;
  unsigned char before = 0;
  for (const char c : name) {
    const auto b = static_cast<unsigned char>(c);
    if (b < 0x20 || b == 0x7F || (before == 0xC2 && b < 0xA0)) return "a name holds no control characters";
    before = b;
    if (c == '.' || c == '/') return "a name holds no '.' and no '/' (they separate components and inner nodes)";
    if ((b & 0xC0u) != 0x80u) ++count;
  }
  if (count > 100) return "a name has at most 100 characters";
  if (name.front() == ' ' || name.back() == ' ') return "a name has no space at its ends";
  if (name == "ground") return "\"ground\" is the inertial frame and can not be a name";
  return "";
}

namespace {

std::shared_ptr<Rule> plain(Form form, Literal about) {
  auto r = std::make_shared<Rule>();
  r->form = form;
  r->about = about;
  return r;
}

std::shared_ptr<Rule> between(Form form, Literal about, double low, bool low_open, double high) {
  auto r = plain(form, about);
  r->low = low;
  r->low_open = low_open;
  r->high = high;
  return r;
}

}  // namespace

RuleRef number_rule(Literal about, double low, bool low_open, double high) {
  return between(Form::number, about, low, low_open, high);
}
RuleRef positive(Literal about) { return number_rule(about, 0.0, true); }
RuleRef not_negative(Literal about) { return number_rule(about, 0.0); }
RuleRef integer_rule(Literal about, double low, double high) { return between(Form::integer, about, low, false, high); }
RuleRef boolean_rule(Literal about) { return plain(Form::boolean, about); }
RuleRef text_rule(Literal about) { return plain(Form::text, about); }
RuleRef name_rule(Literal about) { return plain(Form::name, about); }
RuleRef word_rule(Literal about, std::vector<std::string> words) {
  auto r = plain(Form::word, about);
  r->words = std::move(words);
  return r;
}
RuleRef array_rule(Literal about, RuleRef item, std::size_t min_items, std::size_t max_items) {
  auto r = plain(Form::array, about);
  r->item = std::move(item);
  r->min_items = min_items;
  r->max_items = max_items;
  return r;
}
RuleRef choice_rule(Literal about, std::vector<RuleRef> options) {
  auto r = plain(Form::choice, about);
  r->options = std::move(options);
  return r;
}
RuleRef named_rule(Literal target) {
  auto r = plain(Form::named, {});
  r->target = target;
  return r;
}
Field need(Literal key, RuleRef rule, Literal about) { return {key, std::move(rule), about, Presence::required, {}}; }
Field may(Literal key, RuleRef rule, Literal about, Literal default_json) {
  return {key, std::move(rule), about, Presence::optional, default_json};
}

}  // namespace bough::io
