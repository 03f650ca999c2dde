"""Attachments of an object as the panel has them, and as the scene file has them."""

import numpy as np

from . import maps
from .advice import ERROR, Notice
from .scene_text import Attachment, Painted


class Refused(Exception):
    """Why an attachment cannot be baked, with a remedy."""


def targets(scene):
    """The objects that muslin cloth of the scene is attached to."""
    cloths = [o for o in scene.objects if o.type == "MESH" and o.muslin.role == "CLOTH"]
    return {entry.target for obj in cloths for entry in obj.muslin.attachments if entry.target}


def group_of(index):
    """The group of the mesh's file that an attachment holds, which names the file of its weights too."""
    return f"attached{index + 1}"


def require_ready(obj, scene):
    """Raises Refused."""
    for entry in obj.muslin.attachments:
        target = entry.target
        if target is None:
            raise Refused("An attachment has no object: choose one under Attachments, or remove the attachment")
        if target.name not in scene.objects or scene.objects[target.name] != target:
            raise Refused(f"It is attached to \"{target.name}\", which is not in this scene: choose another object under "
                          "Attachments")
        if target.muslin.role == "NONE":
            raise Refused(f"It is attached to \"{target.name}\", which is neither muslin cloth nor a collider: select it and "
                          "choose one under Physics")
        if not entry.group:
            raise Refused("An attachment has no vertex group: choose one under Attachments, or remove the attachment")
        if entry.group not in obj.vertex_groups:
            raise Refused(f"There is no vertex group \"{entry.group}\" to attach: choose one under Attachments")
        if entry.use_start and entry.use_end and entry.end_frame <= entry.start_frame:
            raise Refused(f"The attachment to \"{target.name}\" ends in frame {entry.end_frame}, before it begins: set Start "
                          "and End under Attachments")


def vertices(obj, weights):
    """{group of the file: its vertices}. `weights`: {vertex group: weight of each vertex}."""
    return {group_of(i): np.flatnonzero(weights[entry.group] > 0) for i, entry in enumerate(obj.muslin.attachments)}


def painted(obj):
    """[(name of a file of weights, vertex group)]."""
    return [(group_of(i), entry.group) for i, entry in enumerate(obj.muslin.attachments)]


def notices_of(obj, weights):
    return [Notice(ERROR, f"No vertex of \"{entry.group}\" has a weight above 0: paint it, or remove the attachment", obj.name)
            for entry in obj.muslin.attachments if not (weights[entry.group] > 0).any()]


def of_object(obj, names, weights, seconds):
    """The attachments of the body. `names`: object → body; `seconds`: frame → time of its end."""
    result = []
    for i, entry in enumerate(obj.muslin.attachments):
        own = weights[entry.group]
        if not (own > 0).any():
            continue
        body = names[obj.name]
        attachment = Attachment(f"attachment {i + 1} of {body}", group_of(i), names[entry.target.name], entry.rest.lower())
        if own[own > 0].min() < 1:
            attachment.weight = Painted(maps.map_file(body, group_of(i)), 0, 1)
        if entry.use_stiffness:
            attachment.stiffness, attachment.damping = entry.stiffness, entry.damping
        if entry.use_break_force:
            attachment.break_force = entry.break_force
        if entry.use_start:
            attachment.begin = seconds(entry.start_frame)
        if entry.use_end:
            attachment.end = seconds(entry.end_frame)
        result.append(attachment)
    return result
