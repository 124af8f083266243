"""What bodies meet: the floor, each other, colliders, and grips.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Tuple, Union

from ._calls import NetworkCalls
from ._core import ffi, filled, lib, with_keywords

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._header import (ColliderDef, ColliderKeywords, ColliderKind, ColliderKindName, ContactDef, ContactInfo,
                          ContactKeywords, FloorDef, FloorKeywords, GripDef, GripKeywords)


class BodyCalls(NetworkCalls):
    """Floor, contact, colliders and grips of a Network."""

    # ---------------------------------------------------------------------------------------------------- floor

    @with_keywords("mspring_floor_def")
    def set_floor(self, planes: Any = None, heights: Any = None, **fields: Unpack[FloorKeywords]) -> None:
        """Set the floor, instead of the one that the network has: half-planes, a field of heights, or both.

        planes   (n, 4): x, y of a point on the border (m), x, y of a normal that points to where particles may be
        heights  (n,), m above heights_y, spacing apart from heights_x on; level ground is [0]
        """
        self._change(lib.mspring_network_set_floor,
                     filled("mspring_floor_def", {"planes": planes, "heights": heights, **fields}))

    def clear_floor(self) -> None:
        """Remove the floor."""
        self._change(lib.mspring_network_set_floor, ffi.NULL)

    @property
    def floor(self) -> FloorDef:
        """The floor's numbers. Without a floor both counts are 0."""
        return self._report("mspring_floor_def", lib.mspring_network_get_floor)

    # -------------------------------------------------------------------------------------------------- contact

    @with_keywords("mspring_contact_def")
    def set_contact(self, **fields: Unpack[ContactKeywords]) -> None:
        """Let the bodies of the network collide, or change how they do. Set it before the network deforms.

        Layers, masks and surfaces are properties: set("layers", 2, ids). If there is contact already, they, colliders
        and events stay.
        """
        self._change(lib.mspring_network_set_contact, filled("mspring_contact_def", dict(fields)))

    def clear_contact(self) -> None:
        """End contact. Layers, surfaces, colliders and events are forgotten."""
        self._change(lib.mspring_network_set_contact, ffi.NULL)

    @property
    def contact(self) -> ContactDef:
        """The contact. Without it capacity is 0."""
        return self._report("mspring_contact_def", lib.mspring_network_get_contact)

    @property
    def contact_info(self) -> ContactInfo:
        """What touched in the last step."""
        return self._report("mspring_contact_info", lib.mspring_network_get_contact_info)

    # ------------------------------------------------------------------------------------------------ colliders

    @with_keywords("mspring_collider_def")
    def add_collider(self, kind: Union[ColliderKind, ColliderKindName] = "chain", points: Any = None,
                     **fields: Unpack[ColliderKeywords]) -> int:
        """Add a shape that you own and move, and that bodies collide with. Returns its id. It needs set_contact().

        kind    "chain", "box" or "circle"
        points  (n, 2), of a chain, m, relative to its position
        """
        return self._made(lib.mspring_network_add_collider,
                          filled("mspring_collider_def", {"kind": kind, "points": points, **fields}))

    def remove_collider(self, collider: int) -> None:
        """Remove a collider."""
        self._change(lib.mspring_network_remove_collider, collider)

    def move_collider(self, collider: int, x: float, y: float, angle: float = 0.0) -> None:
        """Set where a collider is to be at the end of the next step, m and rad. It pushes bodies in its way."""
        self._change(lib.mspring_network_move_collider, collider, x, y, angle)

    def place_collider(self, collider: int, x: float, y: float, angle: float = 0.0) -> None:
        """Put a collider somewhere else at once, m and rad. It touches nothing on its way."""
        self._change(lib.mspring_network_place_collider, collider, x, y, angle)

    def get_collider(self, collider: int) -> ColliderDef:
        """Read a collider: shape, position (m) and angle (rad) now."""
        return self._report("mspring_collider_def", lib.mspring_network_get_collider, collider)

    def get_collider_impulse(self, collider: int) -> Tuple[float, ...]:
        """Read the impulses that bodies gave to a collider in the last step: x, y (N s), angular (N m s)."""
        return self._doubles(lib.mspring_network_get_collider_impulse, 3, collider)

    # ---------------------------------------------------------------------------------------------------- grips

    @with_keywords("mspring_grip_def")
    def add_grip(self, particle: int, **fields: Unpack[GripKeywords]) -> int:
        """Hold a particle softly, as a mouse would. Returns the grip's id."""
        return self._made(lib.mspring_network_add_grip, filled("mspring_grip_def", {"particle": particle, **fields}))

    def set_grip(self, grip: int, **fields: Unpack[GripKeywords]) -> None:
        """Change some fields of a grip."""
        self._modify("mspring_grip_def", lib.mspring_network_get_grip, lib.mspring_network_set_grip, (grip,),
                     dict(fields))

    def remove_grip(self, grip: int) -> None:
        """Let go."""
        self._change(lib.mspring_network_remove_grip, grip)

    def move_grip(self, grip: int, x: float, y: float) -> None:
        """Move the target of a grip to the world position (x, y), m. It goes there in a straight line in one step."""
        self._change(lib.mspring_network_move_grip, grip, x, y)

    def get_grip(self, grip: int) -> GripDef:
        """Read a grip."""
        return self._report("mspring_grip_def", lib.mspring_network_get_grip, grip)

    def get_grip_impulse(self, grip: int) -> Tuple[float, ...]:
        """Read the impulse that a grip gave its particle in the last step, N s."""
        return self._doubles(lib.mspring_network_get_grip_impulse, 2, grip)
