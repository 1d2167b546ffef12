#include "schema_parts.hpp"

namespace bough::io {

void add_signal_rules(RuleTable& t) {
  const RuleRef reference = text_rule("");
  const Field name = need("name", name_rule("A word of formulas: a letter or _, then letters, digits and _."),
                          "Its name, by which formulas call it.");
  const Field frame =
      may("frame", reference, "Frame, node or body that sees the point, and in whose axes. Default: the ground.");
  const RuleRef formula = text_rule("");
  t.named["signal"] = choice_rule(
      "A number that changes with the motion, for efforts of joints and factors of loads. Signals name each other in "
      "any "
      "order, but in a circle only where a state is part of it.",
      {made(object_of_kind({"joint_angle", "joint_displacement"}, "Coordinate of a joint, counting turns [rad] or [m].",
                           {name, need("joint", reference, "The joint.")})),
       made(object_of_kind({"joint_rate"}, "Rate of a joint's coordinate [rad/s] or [m/s]; in statics 0.",
                           {name, need("joint", reference, "The joint."),
                            may("coordinate", word_rule("", {"angle", "displacement"}),
                                "Whose rate. Default: the only coordinate that the joint has.")})),
       made(object_of_kind({"position", "velocity"},
                           "Component of a point's position [m] or velocity [m/s], seen from a frame; in statics the "
                           "velocity is 0.",
                           {name, need("at", named_rule("attachment"), "The point."),
                            need("axis", word_rule("", {"x", "y", "z"}), "Which component."), frame})),
       made(object_of_kind({"time"}, "A law of time.", {name, need("law", named_rule("law"), "The law.")})),
       made(object_of_kind(
           {"function"}, "A law with another signal in the place of time: a table, a ramp.",
           {name, need("of", reference, "The signal in the place of t."), need("law", named_rule("law"), "The law.")})),
       made(object_of_kind({"formula"}, "A formula of other signals and of parameters, as laws have, but without t.",
                           {name, need("expression", formula, "The formula, for instance \"-k*angle - d*rate\".")})),
       made(object_of_kind(
           {"state"},
           "x' = formula of signals, x included: integrators, lags, bristles. Integrated with the motion, to the same "
           "order. In statics, and in the equilibrium at a start, x' = 0.",
           {name, need("expression", formula, "The rate of x, for instance \"(command - x)/lag\"."),
            may("start", number_rule(""), "x at the start of dynamics.", "0")}))});
}

}  // namespace bough::io
