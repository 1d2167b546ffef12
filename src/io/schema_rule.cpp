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

Rule plain(Form form, std::string about) {
  Rule r;
  r.form = form;
  r.about = std::move(about);
  return r;
}

RuleRef share(Rule rule) { return std::make_shared<const Rule>(std::move(rule)); }

}  // namespace

RuleRef number_rule(std::string about, double low, bool low_open, double high) {
  Rule r = plain(Form::number, std::move(about));
  r.low = low;
  r.low_open = low_open;
  r.high = high;
  return share(std::move(r));
}
RuleRef positive(std::string about) { return number_rule(std::move(about), 0.0, true); }
RuleRef not_negative(std::string about) { return number_rule(std::move(about), 0.0); }
RuleRef integer_rule(std::string about, double low, double high) {
  Rule r = plain(Form::integer, std::move(about));
  r.low = low;
  r.high = high;
  return share(std::move(r));
}
RuleRef boolean_rule(std::string about) { return share(plain(Form::boolean, std::move(about))); }
RuleRef text_rule(std::string about) { return share(plain(Form::text, std::move(about))); }
RuleRef name_rule(std::string about) { return share(plain(Form::name, std::move(about))); }
RuleRef word_rule(std::string about, std::vector<std::string> words) {
  Rule r = plain(Form::word, std::move(about));
  r.words = std::move(words);
  return share(std::move(r));
}
RuleRef array_rule(std::string about, RuleRef item, std::size_t min_items, std::size_t max_items) {
  Rule r = plain(Form::array, std::move(about));
  r.item = std::move(item);
  r.min_items = min_items;
  r.max_items = max_items;
  return share(std::move(r));
}
RuleRef choice_rule(std::string about, std::vector<RuleRef> options) {
  Rule r = plain(Form::choice, std::move(about));
  r.options = std::move(options);
  return share(std::move(r));
}
RuleRef named_rule(std::string target) {
  Rule r = plain(Form::named, "");
  r.target = std::move(target);
  return share(std::move(r));
}
Field need(std::string key, RuleRef rule, std::string about) {
  return {std::move(key), std::move(rule), std::move(about), Presence::required, {}};
}
Field may(std::string key, RuleRef rule, std::string about, std::string default_json) {
  return {std::move(key), std::move(rule), std::move(about), Presence::optional, std::move(default_json)};
}

}  // namespace bough::io
