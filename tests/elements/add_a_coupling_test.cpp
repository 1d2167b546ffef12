// The coupling of the manual's page on how to add one, as it stands there.
#include <gtest/gtest.h>

#include "elements/check_element.hpp"
#include "manual_pad.hpp"

namespace bough::elements {

/// Pads are not in the catalogue: nothing else instantiates this.
template <>
Mat6<double> eval_stiffness_at_start<PadOn<motion::Se3>>(const scene::Coupling&, const Frame<double>&,
                                                         const Frame<double>&) {
  return Mat6<double>::zero();
}

namespace check {
namespace {

static_assert(IsCatalogued<PadOn<motion::Se3>> && IsCatalogued<PadOn<motion::Se2>>);

// Along the increments of all nodes, by the complex step.
TEST(AddACoupling, the_coupling_of_the_manual_resists_as_its_energy_says) {
  for (const Ends ends : {Ends::plain, Ends::offset, Ends::grounded}) {
    const auto s = catalogued_sample<PadOn<motion::Se3>>(ends);
    const motion::Vec3Pair anchor = anchor_of(s.element, s.nodes.data());
    const std::vector<double> residual = node_residual<double>(s.element, states_of<double>(s.nodes, anchor), anchor.hi,
                                                               {}, {Vec3<double>::zero(), nullptr, false}, 0.0);
    std::size_t row = 0;
    for (const Port& port : s.element.ports) {
      if (port.node == ground) continue;
      for (int k = 0; k < 6; ++k, ++row) {
        std::vector<NodeState<Complex>> states = states_of<Complex>(s.nodes, anchor);
        NodeState<Complex>& n = states[static_cast<std::size_t>(port.node)];
        n.H = motion::compose(n.H, motion::exp_se3(Vec6<Complex>(Complex(0.0, complex_step) * Vec6<Complex>::unit(k))));
        const auto p = ports_of(s.element, states, anchor.hi);
        EXPECT_NEAR(residual[row], eval_strain_energy(s.element, p.data()).imag() / complex_step, 1e-13);
      }
    }
    EXPECT_EQ(row, residual.size());
  }
}

TEST(AddACoupling, the_coupling_of_the_manual_names_its_numbers_once) {
  const scene::CouplingKind& kind = kind_of<PadOn<motion::Se3>>;
  EXPECT_STREQ(kind.list, "pads");
  ASSERT_EQ(kind.fields.size(), 3U);
  EXPECT_STREQ(kind.fields[1].name, "stiffness");
  PadOn<motion::Se3> pad;
  const double values[5] = {0.0, 3.0, 4.0, 7.0, 0.2};
  take_data(pad, values, Mat3<double>::identity());
  EXPECT_DOUBLE_EQ(pad.direction[1], 0.6);
  EXPECT_EQ(pad.stiffness, 7.0);
  EXPECT_EQ(pad.thickness, 0.2);
}

}  // namespace

}  // namespace check
}  // namespace bough::elements
