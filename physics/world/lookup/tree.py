"""A dynamic tree of bounding boxes: which of many boxes meet a given one.

Every leaf holds the box of one body, every other node the box about its two children. A new leaf
goes where it enlarges the boxes above it least (the surface area heuristic), and rotations keep the
tree balanced as an AVL tree, so that a change takes a time logarithmic in the number of boxes,
wherever they are and however large. (Ericson, *Real-Time Collision Detection*, 6.3; Box2D's tree is
of this kind.) What is found never depends on the tree's history, only the order does.

The first half of ``nodes`` are the leaves, in the order of the bodies; the second half serves as
inner nodes, of which the unused ones are a list.
"""

from ...kernels import kernel
from ..state.records import Indices, Nodes, TreeRecord

NO_ONE = -1


@kernel
def clear_tree(tree: TreeRecord, nodes: Nodes) -> None:
    """Take all leaves out."""
    leaves = nodes.shape[0] // 2
    tree.root = NO_ONE
    tree.free = leaves if leaves > 0 else NO_ONE
    for node in range(nodes.shape[0]):
        nodes[node].parent = node + 1 if leaves <= node < nodes.shape[0] - 1 else NO_ONE


@kernel
def insert_leaf(tree: TreeRecord, nodes: Nodes, leaf: int) -> None:
    """Put a leaf into the tree; its box is set already."""
    nodes[leaf].left = NO_ONE
    nodes[leaf].right = NO_ONE
    nodes[leaf].height = 0
    nodes[leaf].parent = NO_ONE
    if tree.root == NO_ONE:
        tree.root = leaf
        return
    sibling = _best_sibling(tree, nodes, leaf)
    above = nodes[sibling].parent
    parent = tree.free
    tree.free = nodes[parent].parent
    nodes[parent].left = sibling
    nodes[parent].right = leaf
    nodes[sibling].parent = parent
    nodes[leaf].parent = parent
    _replace_child(tree, nodes, above, sibling, parent)
    _refresh(nodes, parent)
    _repair(tree, nodes, above)


@kernel
def remove_leaf(tree: TreeRecord, nodes: Nodes, leaf: int) -> None:
    """Take a leaf out of the tree."""
    parent = nodes[leaf].parent
    if parent == NO_ONE:
        tree.root = NO_ONE
        return
    above = nodes[parent].parent
    sibling = nodes[parent].right if nodes[parent].left == leaf else nodes[parent].left
    _replace_child(tree, nodes, above, parent, sibling)
    nodes[parent].parent = tree.free
    tree.free = parent
    nodes[leaf].parent = NO_ONE
    _repair(tree, nodes, above)


@kernel
def find_leaves(
    tree: TreeRecord,
    nodes: Nodes,
    lower_x: float,
    lower_y: float,
    upper_x: float,
    upper_y: float,
    stack: Indices,
    found: Indices,
    count: int,
) -> int:
    """Append the leaves whose boxes touch or overlap one; return how many there are.

    Args:
        tree, nodes: the tree.
        lower_x, lower_y, upper_x, upper_y: the sides of the box.
        stack: int64 [STACK], scratch memory.
        found: int64, of which ``count`` items are there already.
        count: see above.
    """
    waiting = 0
    if tree.root != NO_ONE:
        stack[0] = tree.root
        waiting = 1
    while waiting > 0:
        waiting -= 1
        index = stack[waiting]
        node = nodes[index]
        if (
            node.lower_x <= upper_x
            and node.upper_x >= lower_x
            and node.lower_y <= upper_y
            and node.upper_y >= lower_y
        ):
            if node.left == NO_ONE:
                found[count] = index
                count += 1
            else:
                stack[waiting] = node.left
                stack[waiting + 1] = node.right
                waiting += 2
    return count


@kernel
def _best_sibling(tree: TreeRecord, nodes: Nodes, leaf: int) -> int:
    """Return the leaf beside which a new one enlarges the boxes least, as far as one can see.

    Not an inner node: its new parent could be out of balance by more than one rotation.
    """
    index = tree.root
    while nodes[index].left != NO_ONE:
        left, right = nodes[index].left, nodes[index].right
        index = left if _cost(nodes, left, leaf) < _cost(nodes, right, leaf) else right
    return int(index)


@kernel
def _cost(nodes: Nodes, node: int, leaf: int) -> float:
    """Return what it costs to go down into a node with a leaf."""
    together = _joint_size(nodes, node, leaf)
    return together if nodes[node].left == NO_ONE else together - _size(nodes, node)


@kernel
def _size(nodes: Nodes, index: int) -> float:
    """Return half the perimeter of a box."""
    node = nodes[index]
    return float((node.upper_x - node.lower_x) + (node.upper_y - node.lower_y))


@kernel
def _joint_size(nodes: Nodes, one: int, other: int) -> float:
    """Return half the perimeter of the box about two boxes."""
    a, b = nodes[one], nodes[other]
    width = max(a.upper_x, b.upper_x) - min(a.lower_x, b.lower_x)
    height = max(a.upper_y, b.upper_y) - min(a.lower_y, b.lower_y)
    return float(width + height)


@kernel
def _replace_child(tree: TreeRecord, nodes: Nodes, parent: int, old: int, new: int) -> None:
    """Put a node at the place of another one."""
    nodes[new].parent = parent
    if parent == NO_ONE:
        tree.root = new
    elif nodes[parent].left == old:
        nodes[parent].left = new
    else:
        nodes[parent].right = new


@kernel
def _refresh(nodes: Nodes, index: int) -> bool:
    """Compute the box and the height of an inner node; return whether they have changed."""
    node = nodes[index]
    left, right = nodes[node.left], nodes[node.right]
    lower_x, lower_y = min(left.lower_x, right.lower_x), min(left.lower_y, right.lower_y)
    upper_x, upper_y = max(left.upper_x, right.upper_x), max(left.upper_y, right.upper_y)
    height = 1 + max(left.height, right.height)
    same = (
        lower_x == node.lower_x
        and lower_y == node.lower_y
        and upper_x == node.upper_x
        and upper_y == node.upper_y
        and height == node.height
    )
    node.lower_x = lower_x
    node.lower_y = lower_y
    node.upper_x = upper_x
    node.upper_y = upper_y
    node.height = height
    return not same


@kernel
def _repair(tree: TreeRecord, nodes: Nodes, index: int) -> None:
    """Balance the nodes from one up to the root, until nothing changes any more."""
    while index != NO_ONE:
        node = nodes[index]
        balance = nodes[node.right].height - nodes[node.left].height
        if balance > 1:
            index = _lift(tree, nodes, index, node.right)
        elif balance < -1:
            index = _lift(tree, nodes, index, node.left)
        elif not _refresh(nodes, index):
            break
        index = nodes[index].parent


@kernel
def _lift(tree: TreeRecord, nodes: Nodes, index: int, child: int) -> int:
    """Rotate the higher child of a node to the node's place; return it."""
    _replace_child(tree, nodes, nodes[index].parent, index, child)
    first, second = nodes[child].left, nodes[child].right
    is_first_higher = nodes[first].height > nodes[second].height
    higher = first if is_first_higher else second
    lower = second if is_first_higher else first
    _replace_child(tree, nodes, index, child, lower)
    nodes[child].left = index
    nodes[child].right = higher
    nodes[index].parent = child
    _refresh(nodes, index)
    _refresh(nodes, child)
    return child
