#include "schema_parts.hpp"

namespace bough::io {

void add_signal_rules(RuleTable& t) {
  const RuleRef reference = text_rule("");
  const Field name = need("name", name_rule("A word of formulas: a letter or _, then letters, digits and _."),
                          "Its name, by which formulas call it.");
  const Field frame =
      may("frame", reference, "Frame, node or body that sees the point, and in whose axes. Default: the ground.");
  const RuleRef formula = text_rule("");
  const auto coordinate = [](Literal about) {
    return may("coordinate", word_rule("", {"angle", "displacement"}), about);
  };
  t.named["signal"] = choice_rule(
      "A number that changes with the motion, for efforts and drives of joints, prescribed motions and factors of "
      "loads. "
      "Signals name each other in any order, but in a circle only where a state is part of it.",
      {made(object_of_kind({"joint_angle", "joint_displacement"}, "Coordinate of a joint, counting turns [rad] or [m].",
                           {name, need("joint", reference, "The joint.")})),
       made(object_of_kind({"joint_rate"}, "Rate of a joint's coordinate [rad/s] or [m/s]; in statics 0.",
                           {name, need("joint", reference, "The joint."),
                            coordinate("Whose rate. Default: the only coordinate that the joint has.")})),
       made(object_of_kind(
           {"joint_effort"},
           "Torque [N m] or force [N] on the second along a coordinate, of all that acts along it: springs, dampers, "
           "efforts, a drive, a rod.",
           {name, need("joint", reference, "The joint."),
            coordinate("Along which. Default: the only coordinate that the joint has.")})),
       made(object_of_kind(
           {"joint_reaction"},
           "Component of the reaction of the first on the second in what the joint holds, about the second's joint "
           "frame "
           "and in the axes of the first's [N], [N m].",
           {name, need("joint", reference, "The joint."),
            need("component", word_rule("", {"fx", "fy", "fz", "mx", "my", "mz"}),
                 "Force along or moment about an axis of the first's joint frame, along which or about which the joint "
                 "leaves nothing free.")})),
       made(object_of_kind({"spring_tension"}, "Tension of a spring, with its damper and all else that it has [N].",
                           {name, need("spring", reference, "The spring.")})),
       made(object_of_kind({"position", "velocity"},
                           "Component of a point's position [m] or velocity [m/s], seen from a frame; in statics the "
                           "velocity is 0.",
                           {name, need("at", named_rule("attachment"), "The point."),
                            need("axis", word_rule("", {"x", "y", "z"}), "Which component."), frame})),
       made(object_of_kind({"time"}, "A law of time.", {name, need("law", named_rule("law"), "The law.")})),
       made(object_of_kind(
           {"function"}, "A law with another signal in the place of time: a table, a ramp.",
           {name, need("of", reference, "The signal in the place of t."), need("law", named_rule("law"), "The law.")})),
       made(object_of_kind(
           {"surface"}, "A table of two signals, bilinear between its points; outside the value of the nearest point.",
           {name, need("of", array_rule("", reference, 2, 2), "The two signals, x and y."),
            need("x", array_rule("", number_rule(""), 1), "Increasing values of the first."),
            need("y", array_rule("", number_rule(""), 1), "Increasing values of the second."),
            need("values", array_rule("", array_rule("", number_rule(""), 1), 1),
                 "One row per x, with one value per y.")})),
       made(object_of_kind({"formula"}, "A formula of other signals and of parameters, as laws have, but without t.",
                           {name, need("expression", formula, "The formula, for instance \"-k*angle - d*rate\".")})),
       made(object_of_kind(
           {"state"},
           "x' = formula of signals, x included: integrators, lags, bristles. Integrated with the motion, to the same "
           "order. In statics, and in the equilibrium at a start, x' = 0.",
           {name, need("expression", formula, "The rate of x, for instance \"(command - x)/lag\"."),
            may("start", number_rule(""), "x at the start of dynamics.", "0"),
            may("nominal", positive(""),
                "Usual size of x, in its unit, in which it is integrated: step_control compares errors of x with it, "
                "or "
                "with the largest x so far where that is more.",
                "1")})),
       made(object_of_kind({"input"},
                           "A number that a program sets between steps (Simulation::set_input); where none does, as in "
                           "`bough run`, it keeps its start.",
                           {name, may("start", number_rule(""), "Until it is set.", "0")}))});
}

}  // namespace bough::io
