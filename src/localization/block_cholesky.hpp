// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <vector>

namespace prodomos::localization {

/// Where a block off the diagonal stands.
struct BlockPlace {
  int row = 0;
  int column = 0;
};

/// A symmetric matrix of blocks of D x D. Of each pair of blocks off the diagonal one is held, whichever.
template <int D>
struct BlockMatrix {
  using Block = Eigen::Matrix<double, D, D>;

  std::vector<Block> diagonal;
  std::vector<BlockPlace> places;  ///< each pair of a row and a column at most once
  std::vector<Block> offDiagonal;  ///< as places
};

/// In which order blocks are eliminated and what structure that gives the factor: the same for blocks of any size.
class Elimination {
 public:
  struct Entry {
    int block = 0;  ///< of the diagonal: the vertex; off it: the index of its place
    int row = 0;    ///< in its piece
    int column = 0;
    bool isDiagonal = false;
    bool isTransposed = false;
  };
  /// Columns [first, first + columns) in the order of elimination, and what lies below.
  struct Supernode {
    int first = 0;
    int columns = 0;
    int parent = -1;
    std::vector<int> rows;      ///< below its columns, ascending
    std::vector<int> inParent;  ///< where the rows are in the parent's piece
    std::vector<int> children;
    std::vector<Entry> entries;
    std::size_t panel = 0;     ///< where its columns of the factor begin, in blocks
    std::size_t nonzeros = 0;  ///< blocks of columns; less than it has room for where supernodes were joined

    int size() const { return columns + static_cast<int>(rows.size()); }
  };

  /// By approximate minimum degree.
  Elimination(int size, const std::vector<BlockPlace>& places);

  const std::vector<Supernode>& supernodes() const { return supernodes_; }  ///< children before parents
  const std::vector<int>& position() const { return position_; }  ///< of each block, in the order of elimination
  std::size_t places() const { return places_; }
  /// Blocks that the factor takes, and that all waiting updates take at most.
  std::size_t factorBlocks() const { return factorBlocks_; }
  std::size_t updateBlocks() const { return updateBlocks_; }

 private:
  void findSupernodes(std::vector<std::vector<int>> rowsOfColumn);
  void linkSupernodes();
  void addEntries(const std::vector<BlockPlace>& places);

  std::vector<int> position_;
  std::vector<Supernode> supernodes_;
  std::vector<int> supernodeOf_;  ///< of each position
  std::size_t places_ = 0;
  std::size_t factorBlocks_ = 0;
  std::size_t updateBlocks_ = 0;
};

/// Cholesky factorisation of sparse, positive definite block matrices, multifrontal: each supernode (columns of one
/// structure, nearly) is a dense piece, which adds what it leaves of later columns to the piece that is its parent in
/// the elimination tree. Duff and Reid 1983; Davis, Direct Methods for Sparse Linear Systems, 2006, chapter 4.
///
/// Blocks of a fixed size make the analysis D² times smaller than one of single numbers, and spare small pieces the
/// price of calls to BLAS. The order of all sums is fixed: same input, same bits.
template <int D>
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, D, D>;

  explicit BlockCholesky(std::shared_ptr<const Elimination> elimination);

  /// Of `matrix`, its diagonal scaled by 1 + damping. False where that is not positive definite.
  bool factorize(const BlockMatrix<D>& matrix, double damping = 0.0);

  /// The solution in the place of the right-hand side; both hold D numbers a block.
  void solve(Eigen::VectorXd& x) const;

  /// Of the inverse, the blocks where the matrix has some; the places of those off the diagonal are as given.
  BlockMatrix<D> inverseBlocks() const;

 private:
  using Supernode = Elimination::Supernode;

  static Eigen::Index wide(int blocks) { return static_cast<Eigen::Index>(blocks) * D; }

  void assemble(const Supernode& node, const BlockMatrix<D>& matrix, double damping);
  void addUpdate(const Supernode& child, const double* update, const Supernode& parent, double* parentUpdate);
  bool eliminate(const Supernode& node, double* update);

  static void gather(const Eigen::MatrixXd& parent, const std::vector<int>& at,
                     Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> target);

  std::shared_ptr<const Elimination> elimination_;
  std::vector<double> factor_;
  std::vector<double> updates_;  ///< a stack: what pieces have left for their parents
};

extern template class BlockCholesky<2>;
extern template class BlockCholesky<3>;
extern template class BlockCholesky<6>;

}  // namespace prodomos::localization
