// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"
#include "prodomos/prediction/surroundings.hpp"

namespace prodomos::prediction {

/// A length that is not known for sure, metres.
struct UncertainLength {
  double mean = 0.0;
  double deviation = 0.0;
};

/// The room behind a door, guessed from what is known around it, with a prior learned from floor plans (docs/rooms.md).
/// 002 predicts a blob of one size there and names that as its limit.
struct RoomGuess {
  /// That a cell (of Surroundings::kCell, in `here`) is floor of the room behind; 0 where something is known or taken,
  /// and where one cannot come from the door through what is unknown.
  geometry::CellMap<float> probability;
  /// The likely room: the box aligned with the door of the greatest expected IoU, without what is known or taken; the
  /// part that hangs together with the door. Empty: none.
  geometry::Polygon outline_here;
  double left = 0.0;  ///< metres, of that box from the door's middle, before it is clipped
  double right = 0.0;
  double depth = 0.0;

  UncertainLength trueLeft;  ///< of the room that is there
  UncertainLength trueRight;
  UncertainLength trueDepth;
  double expectedArea = 0.0;  ///< m², of that room
  double areaDeviation = 0.0;
  double expectedIou = 0.0;       ///< of outline_here with it, given that there is one
  double spaceProbability = 0.0;  ///< that there are at least 2 m² of unseen floor behind, from the surroundings alone
};

/// `around` is told in the frame of the door: middle of the leaf, x to the far side. `doorWidth` in metres; none for
/// one that is not finite or not positive.
RoomGuess guessRoom(const Surroundings& around, double doorWidth);

}  // namespace prodomos::prediction
