#pragma once
/// The kinds of laws as a table, of which schema and reader are made.
#include <functional>
#include <string>
#include <vector>

#include "bough/io/schema_rule.hpp"
#include "bough/laws/law.hpp"

namespace bough::io {

/// Reads a law that is part of another one, at a place of the document.
using ReadLaw = std::function<laws::Law(const JsonValue& value, const std::string& at)>;

struct LawKind {
  Literal name, about;
  std::vector<Field> fields;
  /// Of a value that the rules found without fault. Throws LawError where the numbers make no law.
  laws::Law (*make)(const JsonValue& value, const std::string& at, const ReadLaw& read);
};

const std::vector<LawKind>& law_kinds();

}  // namespace bough::io
