#include "peer.hpp"

namespace bough::bench {

std::vector<Peer> make_peers() {
  std::vector<Peer> peers;
#ifdef BOUGH_BENCH_HAS_KLU
  peers.push_back(make_klu_peer());
#endif
  peers.push_back(make_eigen_lu_peer());
  peers.push_back(make_eigen_ldlt_peer());
#ifdef BOUGH_BENCH_HAS_UMFPACK
  peers.push_back(make_umfpack_peer());
#endif
#ifdef BOUGH_BENCH_HAS_CHOLMOD
  peers.push_back(make_cholmod_peer());
#endif
#ifdef BOUGH_BENCH_HAS_MUMPS
  peers.push_back(make_mumps_peer());
#endif
#ifdef BOUGH_BENCH_HAS_SUPERLU
  peers.push_back(make_superlu_peer());
#endif
  return peers;
}

}  // namespace bough::bench
