/// Frequent operators of motions: bough in double and in packs of 8 lanes, and the same operations by Eigen through
/// AngleAxis, Quaternion and Isometry3d with sine and cosine. One row is IMPLEMENTATION/OPERATOR; the counter `each` is
/// the time of one motion. Before it is timed, every row is compared with bough in double.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "bough/lanes/pack.hpp"
#include "bough/motion/se3.hpp"

namespace {

using namespace bough::motion;
using Lanes = bough::lanes::Pack<8>;
using Vec6d = Eigen::Matrix<double, 6, 1>;
using Mat6d = Eigen::Matrix<double, 6, 6>;

constexpr int count = 256;  // motions in cache, angles spread over (0, 3)

/// Inputs of all operators in the three layouts.
struct Inputs {
  std::vector<Vec6<double>> d, a;
  std::vector<Frame<double>> H, K;
  std::vector<Vec6<Lanes>> d8, a8;
  std::vector<Frame<Lanes>> H8, K8;
  std::vector<Vec6d> de, ae;
  std::vector<Eigen::Isometry3d> He, Ke;

  Inputs() {
    std::mt19937 engine(1);
    const auto vector = [&engine] {
      Vec6<double> v;
      for (double& x : v.v) x = std::uniform_real_distribution<double>(-1.7, 1.7)(engine);
      return v;
    };
    for (int i = 0; i < count; ++i) {
      d.push_back(vector());
      a.push_back(vector());
      H.push_back(exp_se3(d.back()));
      K.push_back(exp_se3(a.back()));
      de.emplace_back(d.back().v);
      ae.emplace_back(a.back().v);
      He.push_back(isometry(H.back()));
      Ke.push_back(isometry(K.back()));
    }
    for (int i = 0; i < count; i += 8) {
      d8.push_back(packed<6>(&d[static_cast<std::size_t>(i)]));
      a8.push_back(packed<6>(&a[static_cast<std::size_t>(i)]));
      H8.push_back(packed(&H[static_cast<std::size_t>(i)]));
      K8.push_back(packed(&K[static_cast<std::size_t>(i)]));
    }
  }
  static Eigen::Isometry3d isometry(const Frame<double>& H) {
    Eigen::Isometry3d r = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
      r.translation()[i] = H.x[i];
      for (int j = 0; j < 3; ++j) r.linear()(i, j) = H.R(i, j);
    }
    return r;
  }
  template <int N>
  static bough::lanes::Vec<Lanes, N> packed(const bough::lanes::Vec<double, N>* v) {
    bough::lanes::Vec<Lanes, N> r;
    for (int lane = 0; lane < 8; ++lane) bough::lanes::set_lane(r, lane, v[lane]);
    return r;
  }
  static Frame<Lanes> packed(const Frame<double>* H) {
    Frame<Lanes> r;
    for (int lane = 0; lane < 8; ++lane) {
      bough::lanes::set_lane(r.R, lane, H[lane].R);
      bough::lanes::set_lane(r.x, lane, H[lane].x);
    }
    return r;
  }
};
const Inputs& inputs() {
  static const Inputs all;
  return all;
}

// The implementation by Eigen.
Eigen::Matrix3d skew_of(const Eigen::Vector3d& a) {
  Eigen::Matrix3d r;
  r << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
  return r;
}
constexpr double small_angle = 1e-8;  // below, the divisor in AngleAxis is inaccurate

Eigen::Matrix3d eigen_exp_so3(const Eigen::Vector3d& psi) {
  const double phi = psi.norm();
  if (phi < small_angle) return Eigen::Matrix3d::Identity() + skew_of(psi);
  return Eigen::AngleAxisd(phi, psi / phi).toRotationMatrix();
}
Eigen::Vector3d eigen_log_so3(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);  // through Eigen's quaternion
  return turn.angle() * turn.axis();
}
Eigen::Isometry3d eigen_exp_se3(const Vec6d& d) {
  const Eigen::Vector3d u = d.head<3>(), psi = d.tail<3>();
  const double phi = psi.norm();
  Eigen::Isometry3d H = Eigen::Isometry3d::Identity();
  H.linear() = eigen_exp_so3(psi);
  if (phi < small_angle) {
    H.translation() = u + 0.5 * psi.cross(u);
    return H;
  }
  const double b = (1.0 - std::cos(phi)) / (phi * phi), c = (phi - std::sin(phi)) / (phi * phi * phi);
  const Eigen::Vector3d across = psi.cross(u);
  H.translation() = u + b * across + c * psi.cross(across);
  return H;
}
Vec6d eigen_log_se3(const Eigen::Isometry3d& H) {
  const Eigen::Vector3d psi = eigen_log_so3(H.linear()), x = H.translation();
  const double phi = psi.norm();
  const double k = phi < small_angle ? 1.0 / 12.0 : (1.0 - 0.5 * phi / std::tan(0.5 * phi)) / (phi * phi);
  const Eigen::Vector3d across = psi.cross(x);
  Vec6d d;
  d << x - 0.5 * across + k * psi.cross(across), psi;
  return d;
}
/// T = [A, B; 0, A]: A = I - b ~psi + c ~psi^2 and B its derivative along u.
Mat6d eigen_tangent(const Vec6d& d) {
  const Eigen::Vector3d u = d.head<3>(), psi = d.tail<3>();
  const double x = psi.squaredNorm(), phi = std::sqrt(x);
  double b = 0.5, c = 1.0 / 6.0, db = -1.0 / 24.0, dc = -1.0 / 120.0;
  if (phi > 1e-3) {
    const double s = std::sin(phi) / phi;
    b = (1.0 - std::cos(phi)) / x;
    c = (1.0 - s) / x;
    db = (s - 2.0 * b) / (2.0 * x);
    dc = (b - 3.0 * c) / (2.0 * x);
  }
  const Eigen::Matrix3d P = skew_of(psi), U = skew_of(u), PP = P * P;
  const double along = 2.0 * psi.dot(u);
  Mat6d T = Mat6d::Zero();
  T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() - b * P + c * PP;
  T.topRightCorner<3, 3>() = -b * U + c * (P * U + U * P) + along * (dc * PP - db * P);
  return T;
}
Vec6d eigen_adjoint_times(const Eigen::Isometry3d& H, const Vec6d& v) {
  const Eigen::Vector3d w = H.linear() * v.tail<3>(), x = H.translation();
  Vec6d r;
  r << H.linear() * v.head<3>() + x.cross(w), w;
  return r;
}

// Results as flat numbers, for the comparison.
template <int N>
void append(std::vector<double>& to, const bough::lanes::Vec<double, N>& v) {
  for (const double x : v.v) to.push_back(x);
}
template <int R, int C>
void append(std::vector<double>& to, const bough::lanes::Mat<double, R, C>& m) {
  for (const double x : m.m) to.push_back(x);
}
template <class D>
void append(std::vector<double>& to, const Eigen::MatrixBase<D>& m) {
  for (int i = 0; i < m.rows(); ++i)
    for (int j = 0; j < m.cols(); ++j) to.push_back(m(i, j));
}
void append(std::vector<double>& to, const Frame<double>& H) {
  append(to, H.R);
  append(to, H.x);
}
void append(std::vector<double>& to, const Eigen::Isometry3d& H) {
  append(to, Eigen::Matrix3d(H.linear()));
  append(to, Eigen::Vector3d(H.translation()));
}
template <int N>
bough::lanes::Vec<double, N> lane_of(const bough::lanes::Vec<Lanes, N>& v, int lane) {
  return get_lane(v, lane);
}
template <int R, int C>
bough::lanes::Mat<double, R, C> lane_of(const bough::lanes::Mat<Lanes, R, C>& m, int lane) {
  return get_lane(m, lane);
}
Frame<double> lane_of(const Frame<Lanes>& H, int lane) { return {get_lane(H.R, lane), get_lane(H.x, lane)}; }

/// One operator three times. f takes the index of a motion, or of eight.
template <class Own, class Packed, class Peer>
void add(const std::string& name, const Own& own, const Packed& packed, const Peer& peer) {
  for (int i = 0; i < count; ++i) {
    std::vector<double> a, b, c;
    append(a, own(static_cast<std::size_t>(i)));
    append(b, lane_of(packed(static_cast<std::size_t>(i / 8)), i % 8));
    append(c, peer(static_cast<std::size_t>(i)));
    for (std::size_t k = 0; k < a.size(); ++k)
      if (a[k] != b[k] || !(std::abs(a[k] - c[k]) <= 1e-12 * (1.0 + std::abs(a[k])))) {
        std::fprintf(stderr, "bench_motion: %s: entry %zu of motion %d is %.17g, in lanes %.17g, by Eigen %.17g\n",
                     name.c_str(), k, i, a[k], b[k], c[k]);
        std::exit(1);
      }
  }
  const auto row = [&name](const char* who, std::size_t calls, const auto& f) {
    benchmark::RegisterBenchmark((who + ("/" + name)).c_str(), [calls, f](benchmark::State& state) {
      for (auto _ : state)
        for (std::size_t i = 0; i < calls; ++i) {
          auto result = f(i);
          benchmark::DoNotOptimize(result);
        }
      state.counters["each"] =
          benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    });
  };
  row("bough", count, own);
  row("lanes", count / 8, packed);
  row("eigen", count, peer);
}

void add_all() {
  const Inputs& in = inputs();
  using I = std::size_t;
  add(
      "exp_so3", [&in](I i) { return exp_so3(angular_part(in.d[i])); },
      [&in](I i) { return exp_so3(angular_part(in.d8[i])); }, [&in](I i) { return eigen_exp_so3(in.de[i].tail<3>()); });
  add(
      "log_so3", [&in](I i) { return log_so3(in.H[i].R); }, [&in](I i) { return log_so3(in.H8[i].R); },
      [&in](I i) { return eigen_log_so3(in.He[i].linear()); });
  add(
      "exp_se3", [&in](I i) { return exp_se3(in.d[i]); }, [&in](I i) { return exp_se3(in.d8[i]); },
      [&in](I i) { return eigen_exp_se3(in.de[i]); });
  add(
      "log_se3", [&in](I i) { return log_se3(in.H[i]); }, [&in](I i) { return log_se3(in.H8[i]); },
      [&in](I i) { return eigen_log_se3(in.He[i]); });
  add(
      "tangent_se3", [&in](I i) { return tangent(in.d[i]); }, [&in](I i) { return tangent(in.d8[i]); },
      [&in](I i) { return eigen_tangent(in.de[i]); });
  add(
      "tensor_times", [&in](I i) { return adjoint_times(in.H[i], in.a[i]); },
      [&in](I i) { return adjoint_times(in.H8[i], in.a8[i]); },
      [&in](I i) { return eigen_adjoint_times(in.He[i], in.ae[i]); });
  add(
      "compose", [&in](I i) { return compose(in.H[i], in.K[i]); }, [&in](I i) { return compose(in.H8[i], in.K8[i]); },
      [&in](I i) { return Eigen::Isometry3d(in.He[i] * in.Ke[i]); });
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
