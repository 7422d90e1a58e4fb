/// @file
/// The processes that share one piece of work: MPI ranks, or this process alone.
#pragma once

#include <functional>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway::sim {

/// Another rank cannot go on.
struct RankFailure : Error {
  RankFailure(const std::string& message, int code) : Error(message), exit_code(code) {}
  int exit_code;
};

/// Rank 0 is the first: it hands out, collects, and alone speaks to the user. MPI is started only
/// when mpirun or srun started the program; used by one thread. With all of it a rank that fails
/// ends the others: it tells the first, which stops everybody.
class Ranks {
 public:
  /// @throws Error when a launcher started several processes and they cannot find each other.
  Ranks();

  /// This process, whoever started it.
  static Ranks alone() { return Ranks(Alone{}); }
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// Whether no launcher started this process, or it is its rank 0. Needs no MPI.
  static bool launched_first();

  int rank() const { return rank_; }
  int count() const { return count_; }
  bool is_first() const { return rank_ == 0; }

  /// The first sends, the others receive the same bytes.
  std::string from_first(const std::string& bytes) const;

  /// The others send; the first calls f with the bytes of each, in the order of arrival.
  /// @throws RankFailure at the first when a rank sent that instead.
  void to_first(const std::string& bytes, const std::function<void(const std::string&)>& f) const;

  /// At the first, now and then while it works. @throws RankFailure when another rank has failed.
  void check_others() const;

  /// Ends all ranks with the exit code: from the first at once, from another by telling the first,
  /// which learns of it in check_others() or to_first(). @pre count() > 1.
  [[noreturn]] void stop(const std::string& message, int exit_code) const;

 private:
  struct Alone {};
  explicit Ranks(Alone) {}

  int rank_{0};
  int count_{1};
  [[maybe_unused]] bool has_started_mpi_{false};  // unused when built without MPI
};

}  // namespace leeway::sim
