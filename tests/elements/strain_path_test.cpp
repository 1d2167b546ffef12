/// The path of a large correction on which strains change in proportion.
#include "bough/elements/strain_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bough::elements::check {
namespace {

constexpr double length = 2.0;

template <int N>
constexpr int reference = Beam<N>::reference;

/// Poses of a beam that is bent, twisted, sheared and stretched, and corrections of its sections of the size of
/// `size` rad.
template <int N>
struct Bent {
  PortMotion<double> ports[N];
  Vec6<double> eta[N];
  BeamShape<double, N> shape;

  explicit Bent(double size, double bend = 1.0) {
    for (int i = 0; i < N; ++i) {
      const double s = length * i / (N - 1);
      ports[i].H = motion::Se3::exp(
          Vec6<double>{{1.02 * s, 0.03 * s, -0.1 * s * s, 0.2 * bend * s, 0.3 * bend * s, 0.2 * bend * s * s}});
      for (int k = 0; k < 6; ++k) eta[i][k] = size * std::sin(1.0 + 2.3 * i + 1.7 * k);
    }
    shape = eval_shape<double, N>(ports);
  }

  /// Of the logarithms, by unit of the factor at its start.
  Vec6<double> correction(int i) const {
    return shape.inverse[i].times(eta[i] - motion::inverse_adjoint_times(shape.relative[i], eta[reference<N>]));
  }

  Vec6<double> strain(const Vec6<double>* d, int point) const {
    BeamShape<double, N> b = shape;
    for (int i = 0, k = 0; i < N; ++i)
      if (i != reference<N>) b.d[i] = d[k++];
    return eval_strain<double, N>(b, length, point);
  }

  /// (de/dd) correction, by differences of fourth order.
  Vec6<double> strain_rate(int point) const {
    constexpr double h = 1e-3;
    const auto at = [&](double factor) {
      Vec6<double> d[N - 1];
      for (int i = 0, k = 0; i < N; ++i)
        if (i != reference<N>) d[k++] = shape.d[i] + factor * correction(i);
      return strain(d, point);
    };
    return (1.0 / (12.0 * h)) * (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h)));
  }
};

template <int N>
struct Path {
  Vec6<double> end[N - 1], twist[N - 1];
  Frame<double> motion[N - 1];
};

/// The path of the first of some beams, the others in the other lanes.
template <int N>
Path<N> path_of(const std::vector<Bent<N>>& beams, double factor) {
  PortMotion<LanePack> ports[N];
  Vec6<LanePack> eta[N], strain_rates[N - 1], ends[N - 1], twists[N - 1];
  for (int lane = 0; lane < num_lanes; ++lane) {
    const Bent<N>& beam = beams[static_cast<std::size_t>(lane) % beams.size()];
    for (int i = 0; i < N; ++i) {
      lanes::set_lane(ports[i].H.R, lane, beam.ports[i].H.R);
      lanes::set_lane(ports[i].H.x, lane, beam.ports[i].H.x);
      lanes::set_lane(eta[i], lane, beam.eta[i]);
    }
  }
  SectionWay<LanePack> ways[N - 1];
  eval_strain_path<N>(ports, eta, LanePack(factor), ways, strain_rates);
  for (int k = 0; k < N - 1; ++k) ends[k] = ways[k].end;
  eval_strain_path_twists<N>(ends, strain_rates, twists);
  Path<N> path;
  for (int k = 0; k < N - 1; ++k) {
    path.end[k] = lanes::get_lane(ends[k], 0);
    path.twist[k] = lanes::get_lane(twists[k], 0);
    path.motion[k].R =
        motion::rotation_of(motion::Quaternion<double>{ways[k].turn.w[0], lanes::get_lane(ways[k].turn.v, 0)});
    path.motion[k].x = lanes::get_lane(ways[k].shift, 0);
  }
  return path;
}

template <int N>
void expect_proportional_strains(double factor) {
  const Bent<N> beam(0.3);
  const Path<N> path = path_of<N>({beam}, factor);
  double bent = 0.0;
  for (int g = 0; g < N - 1; ++g) {
    const Vec6<double> before = eval_strain<double, N>(beam.shape, length, g), after = beam.strain(path.end, g),
                       rate = beam.strain_rate(g);
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(after[k], before[k] + factor * rate[k], 1e-10) << N << " nodes, point " << g << ", strain " << k;
      bent = std::max(bent, std::abs(factor * rate[k]));
    }
  }
  EXPECT_GT(bent, 0.1 * std::abs(factor));  // the correction is a large one
}

TEST(StrainPath, strains_change_in_proportion_to_the_correction) {
  for (const double factor : {-0.7, 0.3, 1.0}) {
    expect_proportional_strains<2>(factor);
    expect_proportional_strains<3>(factor);
    expect_proportional_strains<4>(factor);
  }
}

/// The motions of the sections lead to the logarithms at the end, whether changes are large or keep their digits.
template <int N>
void expect_motions_to_the_end() {
  for (const double size : {1e-12, 1e-7, 1e-4, 0.3}) {
    const Bent<N> beam(size);
    const Path<N> path = path_of<N>({beam}, 1.0);
    for (int i = 0, k = 0; i < N; ++i) {
      if (i == reference<N>) continue;
      const Vec6<double> end = motion::Se3::log(motion::compose(beam.shape.relative[i], path.motion[k]));
      const Vec6<double> own = motion::Se3::log(path.motion[k]),
                         alone = beam.eta[i] -
                                 motion::inverse_adjoint_times(beam.shape.relative[i], beam.eta[reference<N>]);
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(end[c], path.end[k][c], 1e-14) << size;
        if (size < 1e-6) {  // nothing but the correction, to second order
          EXPECT_NEAR(own[c], alone[c], 10.0 * size * size + 1e-14 * size) << size;
        }
      }
      ++k;
    }
  }
}

TEST(StrainPath, motions_of_the_sections_lead_to_its_end) {
  expect_motions_to_the_end<2>();
  expect_motions_to_the_end<3>();
  expect_motions_to_the_end<4>();
}

template <int N>
void expect_true_twists(const Bent<N>& beam, double tolerance) {
  constexpr double s = 0.6, h = 1e-5;
  const Path<N> before = path_of<N>({beam}, s - h), at = path_of<N>({beam}, s), after = path_of<N>({beam}, s + h);
  for (int k = 0; k < N - 1; ++k) {
    const Vec6<double> twist =
        motion::tangent_times(at.end[k], Vec6<double>((0.5 / h) * (after.end[k] - before.end[k])));
    for (int c = 0; c < 6; ++c) EXPECT_NEAR(at.twist[k][c], twist[c], tolerance) << N << ", " << k;
  }
}

TEST(StrainPath, tells_the_twists_at_its_end) {
  expect_true_twists(Bent<2>(0.3), 1e-9);
  expect_true_twists(Bent<3>(0.3), 1e-9);
  expect_true_twists(Bent<4>(0.3), 1e-9);
}

template <int N>
bool is_linear(const Bent<N>& beam) {
  const Path<N> path = path_of<N>({beam}, 1.0);
  bool is = true;
  for (int i = 0, k = 0; i < N; ++i)
    for (int c = 0; c < 6 && i != reference<N>; ++c, k += c == 6 ? 1 : 0)
      is = is && path.end[k][c] == beam.shape.d[i][c] + beam.correction(i)[c];
  return is;
}

TEST(StrainPath, a_correction_that_no_shape_follows_stays_linear) {
  EXPECT_FALSE(is_linear(Bent<3>(0.3)));
  EXPECT_TRUE(is_linear(Bent<3>(60.0)));
  EXPECT_TRUE(is_linear(Bent<4>(60.0)));
}

/// A lane keeps its bits beside others that are done sooner or later, or never.
TEST(StrainPath, a_lane_does_not_depend_on_its_neighbours) {
  const Bent<4> beam(0.2);
  const Path<4> alone = path_of<4>({beam}, 1.0),
                among = path_of<4>({beam, Bent<4>(1e-12), Bent<4>(60.0), Bent<4>(0.5)}, 1.0);
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 6; ++c) {
      EXPECT_EQ(alone.end[k][c], among.end[k][c]);
      EXPECT_EQ(alone.twist[k][c], among.twist[k][c]);
    }
}

}  // namespace
}  // namespace bough::elements::check
