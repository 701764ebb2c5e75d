// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <numeric>

namespace prodomos::localization {

namespace {

using Panel = Eigen::Map<Eigen::MatrixXd>;
using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

/// Blocks in the order of their elimination.
std::vector<int> minimumDegreeOrder(int size, const std::vector<BlockPlace>& places) {
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(places.size() * 2);
  for (const auto& place : places) {
    triplets.emplace_back(place.row, place.column, 1.0);
    triplets.emplace_back(place.column, place.row, 1.0);
  }
  // Without its diagonal Eigen takes a column for a dense one, and leaves it for the end.
  for (int block = 0; block < size; ++block) triplets.emplace_back(block, block, 1.0);
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  return {order.indices().data(), order.indices().data() + size};
}

/// Of each position the later ones that it is tied to.
std::vector<std::vector<int>> laterNeighbours(const std::vector<int>& position, const std::vector<BlockPlace>& places) {
  std::vector<std::vector<int>> later(position.size());
  for (const auto& place : places) {
    const auto [first, second] =
        std::minmax(position[static_cast<std::size_t>(place.row)], position[static_cast<std::size_t>(place.column)]);
    later[static_cast<std::size_t>(first)].push_back(second);
  }
  return later;
}

/// Below each column of the factor the rows that are not zero, ascending; the first is its parent in the elimination
/// tree.
std::vector<std::vector<int>> factorRows(std::vector<std::vector<int>> rows) {
  std::vector<int> seenBy(rows.size(), -1);
  std::vector<std::vector<int>> children(rows.size());
  for (std::size_t column = 0; column < rows.size(); ++column) {
    std::vector<int> merged;
    const auto add = [&](int row) {
      const auto at = static_cast<std::size_t>(row);
      if (row == static_cast<int>(column) || seenBy[at] == static_cast<int>(column)) return;
      seenBy[at] = static_cast<int>(column);
      merged.push_back(row);
    };
    std::ranges::for_each(rows[column], add);
    for (const int child : children[column]) std::ranges::for_each(rows[static_cast<std::size_t>(child)], add);
    std::ranges::sort(merged);
    if (!merged.empty()) children[static_cast<std::size_t>(merged.front())].push_back(static_cast<int>(column));
    rows[column] = std::move(merged);
  }
  return rows;
}

/// Columns such that the subtree of each stands right before it.
std::vector<int> postorder(const std::vector<std::vector<int>>& rows) {
  const auto size = rows.size();
  std::vector<std::vector<int>> children(size);
  std::vector<int> stack;
  for (std::size_t column = size; column-- > 0;) {
    const bool isRoot = rows[column].empty();
    (isRoot ? stack : children[static_cast<std::size_t>(rows[column].front())]).push_back(static_cast<int>(column));
  }
  // Parents before children, then turned round.
  std::vector<int> order;
  order.reserve(size);
  while (!stack.empty()) {
    const int column = stack.back();
    stack.pop_back();
    order.push_back(column);
    const auto& below = children[static_cast<std::size_t>(column)];
    stack.insert(stack.end(), below.begin(), below.end());
  }
  std::ranges::reverse(order);
  return order;
}

std::size_t blocksIn(std::size_t columns, std::size_t rows) {
  return columns * (columns + 1) / 2 + columns * rows;
}

/// Dense pieces win over sparse ones by more than some zeros cost; small ones most.
bool isWorthJoining(std::size_t columns, std::size_t room, std::size_t nonzeros) {
  const double zeros = static_cast<double>(room - nonzeros) / static_cast<double>(room);
  return columns <= 2 ? zeros < 0.5 : columns <= 6 ? zeros < 0.2 : zeros < 0.05;
}

}  // namespace

Elimination::Elimination(int size, const std::vector<BlockPlace>& places)
    : position_(static_cast<std::size_t>(size)), places_(places.size()) {
  auto order = minimumDegreeOrder(size, places);
  const auto place = [&] {
    for (int at = 0; at < size; ++at) position_[static_cast<std::size_t>(order[static_cast<std::size_t>(at)])] = at;
  };
  place();
  const auto byTree = postorder(factorRows(laterNeighbours(position_, places)));
  std::vector<int> reordered(order.size());
  std::ranges::transform(byTree, reordered.begin(),
                         [&](int column) { return order[static_cast<std::size_t>(column)]; });
  order = std::move(reordered);
  place();
  findSupernodes(factorRows(laterNeighbours(position_, places)));
  linkSupernodes();
  addEntries(places);
}

void Elimination::findSupernodes(std::vector<std::vector<int>> rowsOfColumn) {
  for (std::size_t column = 0; column < rowsOfColumn.size(); ++column) {
    Supernode node{.first = static_cast<int>(column), .columns = 1, .rows = std::move(rowsOfColumn[column])};
    node.nonzeros = blocksIn(1, node.rows.size());
    while (!supernodes_.empty()) {
      const auto& before = supernodes_.back();
      const bool isChild = !before.rows.empty() && before.rows.front() < node.first + node.columns;
      if (!isChild) break;
      const auto columns = static_cast<std::size_t>(before.columns) + static_cast<std::size_t>(node.columns);
      const auto nonzeros = before.nonzeros + node.nonzeros;
      if (!isWorthJoining(columns, blocksIn(columns, node.rows.size()), nonzeros)) break;
      node.first = before.first;
      node.columns = static_cast<int>(columns);
      node.nonzeros = nonzeros;
      supernodes_.pop_back();
    }
    supernodes_.push_back(std::move(node));
  }
}

void Elimination::linkSupernodes() {
  supernodeOf_.resize(position_.size());
  for (std::size_t i = 0; i < supernodes_.size(); ++i) {
    auto& node = supernodes_[i];
    std::fill_n(supernodeOf_.begin() + node.first, node.columns, static_cast<int>(i));
    node.panel = factorBlocks_;
    factorBlocks_ += static_cast<std::size_t>(node.columns) * static_cast<std::size_t>(node.size());
  }
  std::size_t top = 0;
  const auto updateSize = [](const Supernode& node) { return node.rows.size() * node.rows.size(); };
  for (std::size_t i = 0; i < supernodes_.size(); ++i) {
    auto& node = supernodes_[i];
    updateBlocks_ = std::max(updateBlocks_, top + updateSize(node));
    for (const int child : node.children) top -= updateSize(supernodes_[static_cast<std::size_t>(child)]);
    top += updateSize(node);
    if (node.rows.empty()) continue;
    node.parent = supernodeOf_[static_cast<std::size_t>(node.rows.front())];
    auto& parent = supernodes_[static_cast<std::size_t>(node.parent)];
    parent.children.push_back(static_cast<int>(i));
    auto at = parent.rows.begin();
    for (const int row : node.rows) {
      if (row < parent.first + parent.columns) {
        node.inParent.push_back(row - parent.first);
      } else {
        at = std::lower_bound(at, parent.rows.end(), row);
        node.inParent.push_back(parent.columns + static_cast<int>(at - parent.rows.begin()));
      }
    }
  }
}

void Elimination::addEntries(const std::vector<BlockPlace>& places) {
  for (std::size_t block = 0; block < position_.size(); ++block) {
    auto& node = supernodes_[static_cast<std::size_t>(supernodeOf_[static_cast<std::size_t>(position_[block])])];
    const int at = position_[block] - node.first;
    node.entries.push_back({.block = static_cast<int>(block), .row = at, .column = at, .isDiagonal = true});
  }
  for (std::size_t block = 0; block < places.size(); ++block) {
    int row = position_[static_cast<std::size_t>(places[block].row)];
    int column = position_[static_cast<std::size_t>(places[block].column)];
    const bool isTransposed = row < column;
    if (isTransposed) std::swap(row, column);
    auto& node = supernodes_[static_cast<std::size_t>(supernodeOf_[static_cast<std::size_t>(column)])];
    const auto below = std::ranges::lower_bound(node.rows, row) - node.rows.begin();
    const bool isInside = row < node.first + node.columns;
    node.entries.push_back({.block = static_cast<int>(block),
                            .row = isInside ? row - node.first : node.columns + static_cast<int>(below),
                            .column = column - node.first,
                            .isTransposed = isTransposed});
  }
}

template <int D>
BlockCholesky<D>::BlockCholesky(std::shared_ptr<const Elimination> elimination)
    : elimination_(std::move(elimination)),
      factor_(elimination_->factorBlocks() * D * D),
      updates_(elimination_->updateBlocks() * D * D) {}

template <int D>
bool BlockCholesky<D>::factorize(const BlockMatrix<D>& matrix, double damping) {
  std::ranges::fill(factor_, 0.0);
  double* top = updates_.data();
  for (const auto& node : elimination_->supernodes()) {
    // The children's updates are the last on the stack. What this piece leaves is added up above them, then takes
    // their place.
    const auto size = node.rows.size() * node.rows.size() * D * D;
    double* update = top;
    std::fill_n(update, size, 0.0);
    double* bottom = top;
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      const auto& from = elimination_->supernodes()[static_cast<std::size_t>(*child)];
      bottom -= from.rows.size() * from.rows.size() * D * D;
      addUpdate(from, bottom, node, update);
    }
    assemble(node, matrix, damping);
    if (!eliminate(node, update)) return false;
    std::copy_n(update, size, bottom);
    top = bottom + size;
  }
  return true;
}

template <int D>
void BlockCholesky<D>::assemble(const Supernode& node, const BlockMatrix<D>& matrix, double damping) {
  Panel panel(factor_.data() + node.panel * D * D, wide(node.size()), wide(node.columns));
  for (const auto& entry : node.entries) {
    auto target = panel.template block<D, D>(wide(entry.row), wide(entry.column));
    const auto block = static_cast<std::size_t>(entry.block);
    if (entry.isDiagonal) {
      target += matrix.diagonal[block];
      target.diagonal() += damping * matrix.diagonal[block].diagonal();
    } else if (entry.isTransposed) {
      target += matrix.offDiagonal[block].transpose();
    } else {
      target += matrix.offDiagonal[block];
    }
  }
}

template <int D>
void BlockCholesky<D>::addUpdate(const Supernode& child, const double* update, const Supernode& parent,
                                 double* parentUpdate) {
  const auto count = child.inParent.size();
  const auto stride = count * D;
  double* const panel = factor_.data() + parent.panel * D * D;
  const auto panelStride = static_cast<std::size_t>(wide(parent.size()));
  const auto updateStride = parent.rows.size() * D;
  for (std::size_t column = 0; column < count; ++column) {
    const int at = child.inParent[column];
    const bool isInside = at < parent.columns;
    // Rows count from the piece's first column, in the update from the first row below.
    const int firstRow = isInside ? 0 : parent.columns;
    const auto targetStride = isInside ? panelStride : updateStride;
    double* target = (isInside ? panel : parentUpdate) + static_cast<std::size_t>(wide(at - firstRow)) * targetStride;
    const double* source = update + column * D * stride;
    for (int k = 0; k < D; ++k, target += targetStride, source += stride) {
      for (std::size_t row = column; row < count; ++row) {
        double* const to = target + wide(child.inParent[row] - firstRow);
        const double* const from = source + row * D;
        for (int i = 0; i < D; ++i) to[i] += from[i];
      }
    }
  }
}

template <int D>
bool BlockCholesky<D>::eliminate(const Supernode& node, double* update) {
  const Eigen::Index columns = wide(node.columns);
  const auto rows = static_cast<Eigen::Index>(node.rows.size()) * D;
  Panel panel(factor_.data() + node.panel * D * D, columns + rows, columns);
  Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> head = panel.topRows(columns);
  auto tail = panel.bottomRows(rows);
  if (node.columns == 1) {
    const Eigen::LLT<Block> llt(panel.template topRows<D>());
    if (llt.info() != Eigen::Success) return false;
    const Block lower = llt.matrixL();
    panel.template topRows<D>() = lower;
    for (Eigen::Index row = 0; row < rows; row += D) {
      const Block block = tail.template middleRows<D>(row).transpose();
      tail.template middleRows<D>(row) = lower.template triangularView<Eigen::Lower>().solve(block).transpose();
    }
  } else {
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>> llt(head);
    if (llt.info() != Eigen::Success) return false;
    if (rows > 0) {
      head.triangularView<Eigen::Lower>().transpose().template solveInPlace<Eigen::OnTheRight>(tail);
    }
  }
  if (rows > 0) Panel(update, rows, rows).template selfadjointView<Eigen::Lower>().rankUpdate(tail, -1.0);
  return true;
}

template <int D>
void BlockCholesky<D>::solve(Eigen::VectorXd& x) const {
  Eigen::VectorXd ordered(x.size());
  for (std::size_t block = 0; block < elimination_->position().size(); ++block) {
    ordered.segment<D>(wide(elimination_->position()[block])) = x.segment<D>(static_cast<Eigen::Index>(block) * D);
  }
  Eigen::VectorXd below;
  const auto panelOf = [&](const Supernode& node) {
    return ConstPanel(factor_.data() + node.panel * D * D, wide(node.size()), wide(node.columns));
  };
  for (const auto& node : elimination_->supernodes()) {
    const auto panel = panelOf(node);
    auto head = ordered.segment(wide(node.first), wide(node.columns));
    panel.topRows(wide(node.columns)).template triangularView<Eigen::Lower>().solveInPlace(head);
    below.noalias() = panel.bottomRows(panel.rows() - panel.cols()) * head;
    for (std::size_t i = 0; i < node.rows.size(); ++i) {
      ordered.segment<D>(wide(node.rows[i])) -= below.segment<D>(static_cast<Eigen::Index>(i) * D);
    }
  }
  for (std::size_t at = elimination_->supernodes().size(); at-- > 0;) {
    const auto& node = elimination_->supernodes()[at];
    const auto panel = panelOf(node);
    below.resize(panel.rows() - panel.cols());
    for (std::size_t i = 0; i < node.rows.size(); ++i) {
      below.segment<D>(static_cast<Eigen::Index>(i) * D) = ordered.segment<D>(wide(node.rows[i]));
    }
    auto head = ordered.segment(wide(node.first), wide(node.columns));
    head.noalias() -= panel.bottomRows(below.size()).transpose() * below;
    panel.topRows(wide(node.columns)).template triangularView<Eigen::Lower>().transpose().solveInPlace(head);
  }
  for (std::size_t block = 0; block < elimination_->position().size(); ++block) {
    x.segment<D>(static_cast<Eigen::Index>(block) * D) = ordered.segment<D>(wide(elimination_->position()[block]));
  }
}

template <int D>
void BlockCholesky<D>::gather(const Eigen::MatrixXd& parent, const std::vector<int>& at,
                              Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> target) {
  for (std::size_t column = 0; column < at.size(); ++column) {
    for (std::size_t row = 0; row < at.size(); ++row) {
      target.template block<D, D>(static_cast<Eigen::Index>(row) * D, static_cast<Eigen::Index>(column) * D) =
          parent.template block<D, D>(wide(at[row]), wide(at[column]));
    }
  }
}

template <int D>
BlockMatrix<D> BlockCholesky<D>::inverseBlocks() const {
  BlockMatrix<D> inverse;
  inverse.diagonal.resize(elimination_->position().size());
  inverse.offDiagonal.resize(elimination_->places());
  // Of each piece the inverse's dense part, from the roots down; let go when the last child has drawn on it.
  std::vector<Eigen::MatrixXd> parts(elimination_->supernodes().size());
  for (std::size_t i = elimination_->supernodes().size(); i-- > 0;) {
    const auto& node = elimination_->supernodes()[i];
    const Eigen::Index columns = wide(node.columns);
    const Eigen::Index rows = wide(node.size()) - columns;
    const ConstPanel panel(factor_.data() + node.panel * D * D, columns + rows, columns);
    auto& part = parts[i];
    part = Eigen::MatrixXd::Zero(columns + rows, columns + rows);
    const auto head = panel.topRows(columns).template triangularView<Eigen::Lower>();
    Eigen::MatrixXd inverseHead = Eigen::MatrixXd::Identity(columns, columns);
    head.solveInPlace(inverseHead);
    part.topLeftCorner(columns, columns).noalias() = inverseHead.transpose() * inverseHead;
    if (rows > 0) {
      auto below = part.bottomRightCorner(rows, rows);
      gather(parts[static_cast<std::size_t>(node.parent)], node.inParent, below);
      const Eigen::MatrixXd gain = panel.bottomRows(rows) * inverseHead;
      part.bottomLeftCorner(rows, columns).noalias() = -below * gain;
      part.topRightCorner(columns, rows) = part.bottomLeftCorner(rows, columns).transpose();
      part.topLeftCorner(columns, columns).noalias() -= gain.transpose() * part.bottomLeftCorner(rows, columns);
      auto& parent = elimination_->supernodes()[static_cast<std::size_t>(node.parent)];
      if (parent.children.front() == static_cast<int>(i)) parts[static_cast<std::size_t>(node.parent)].resize(0, 0);
    }
    for (const auto& entry : node.entries) {
      const auto block = part.template block<D, D>(wide(entry.row), wide(entry.column));
      if (entry.isDiagonal) {
        inverse.diagonal[static_cast<std::size_t>(entry.block)] = block;
      } else if (entry.isTransposed) {
        inverse.offDiagonal[static_cast<std::size_t>(entry.block)] = block.transpose();
      } else {
        inverse.offDiagonal[static_cast<std::size_t>(entry.block)] = block;
      }
    }
  }
  return inverse;
}

template class BlockCholesky<2>;
template class BlockCholesky<3>;
template class BlockCholesky<6>;

}  // namespace prodomos::localization
