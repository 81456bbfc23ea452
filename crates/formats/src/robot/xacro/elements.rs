//! Which elements are of xacro, and which of those call no macro.

use roxmltree::Node;

/// Elements of xacro that call no macro; `call` calls the one that its attribute names.
pub(super) const DIRECTIVES: [&str; 9] = [
    "property",
    "arg",
    "macro",
    "if",
    "unless",
    "insert_block",
    "include",
    "element",
    "attribute",
];

/// Whether this is an element of xacro, whatever prefix the file gives it.
pub(super) fn is_xacro(node: Node<'_, '_>) -> bool {
    node.tag_name()
        .namespace()
        .is_some_and(|uri| uri.contains("xacro"))
}

/// Whether this is an element of URDF itself, of this name.
pub(super) fn is_plain(node: Node<'_, '_>, name: &str) -> bool {
    node.is_element() && node.tag_name().name() == name && !is_xacro(node)
}
