#include "bough/scene/signals.hpp"
#include "schema_parts.hpp"

namespace bough::io {

namespace {

using scene::SignalField;

/// The keys of a field.
std::vector<Field> keys_of(SignalField field) {
  const RuleRef reference = text_rule(""), numbers = array_rule("", number_rule(""), 1);
  switch (field) {
    case SignalField::joint:
      return {need("joint", reference, "The joint.")};
    case SignalField::coordinate:
      return {may("coordinate", word_rule("", {"angle", "displacement"}),
                  "Which of its coordinates. Default: the only one that the joint has.")};
    case SignalField::effort_part:
      return {effort_part_field()};
    case SignalField::component:
      return {need("component", word_rule("", {"fx", "fy", "fz", "mx", "my", "mz"}),
                   "Force along or moment about an axis of the first's joint frame, along which or about which the "
                   "joint leaves nothing free.")};
    case SignalField::part:
      return {need("of", reference, "The prescribed motion or the load."),
              need("component", word_rule("", {"fx", "fy", "fz", "mx", "my", "mz"}),
                   "Force along or moment about an axis; of a prescribed motion one that it holds.")};
    case SignalField::spring:
      return {need("spring", reference, "The spring.")};
    case SignalField::point:
      return {need("at", named_rule("attachment"), "The point."),
              need("axis", word_rule("", {"x", "y", "z"}), "Which component.")};
    case SignalField::frame:
      return {may("frame", reference,
                  "Frame, node or body that sees the point, and in whose axes. Default: the "
                  "ground.")};
    case SignalField::law:
      return {need("law", named_rule("law"), "The law.")};
    case SignalField::of:
      return {need("of", reference, "The signal in the place of t.")};
    case SignalField::table:
      return {need("of", array_rule("", reference, 2, 2), "The two signals, x and y."),
              need("x", numbers, "Increasing values of the first."),
              need("y", numbers, "Increasing values of the second."),
              need("values", array_rule("", numbers, 1), "One row per x, with one value per y.")};
    case SignalField::expression:
      return {need("expression", text_rule(""),
                   "The formula, for instance \"-k*angle - d*rate\"; of a state that of its rate, as in \"(command - "
                   "x)/lag\".")};
    case SignalField::start:
      return {may("start", number_rule(""), "Value at the start of dynamics; of an input until it is set.", "0")};
    case SignalField::nominal:
      return {may("nominal", positive(""),
                  "Usual size of x, in its unit, in which it is integrated: step_control compares errors of x with "
                  "it, or with the largest x so far where that is more.",
                  "1")};
    case SignalField::unit:
      return {may("unit", text_rule("At most 30 characters."),
                  "Unit of its value, shown with results; \"-\" for a pure number. Nothing is converted. Default: what "
                  "follows from its formula, or from the effort or drive that it is.")};
  }
  return {};
}

}  // namespace

Field effort_part_field() {
  return may(
      "of", text_rule(""),
      "The part that is read. \"all\": springs, dampers, efforts, and the drive or rod that prescribes the "
      "coordinate, which is what moves the second along it. \"drive\": the drive or rod alone, what a motor has to "
      "give. \"spring\", \"damper\", \"effort\": these of all forces of the joint; friction, limits and servos are "
      "efforts. Otherwise the name of one of the forces of the joint.",
      "\"all\"");
}

void add_signal_rules(RuleTable& t) {
  std::vector<RuleRef> kinds;
  for (const scene::SignalType& type : scene::signal_types()) {
    std::vector<Field> keys{need("name", name_rule("A word of formulas: a letter or _, then letters, digits and _."),
                                 "Its name, by which formulas call it.")};
    for (const SignalField field : type.fields)
      for (const Field& key : keys_of(field)) keys.push_back(key);
    kinds.push_back(made(object_of_kind({std::string(type.name)}, type.about.data(), std::move(keys))));
  }
  t.named["signal"] = choice_rule(
      "A number that changes with the motion, for efforts and drives of joints, prescribed motions and factors of "
      "loads. Signals name each other in any order, but in a circle only where a state is part of it.",
      std::move(kinds));
}

}  // namespace bough::io
