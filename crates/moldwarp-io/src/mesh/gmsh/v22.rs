//! The sections of MSH 2.2: one list of nodes, one of elements with their groups.

use super::Result;
use super::assembly::Assembly;
use super::cursor::Cursor;
use super::element_type::ElementType;
use moldwarp::Vec3;

/// `$Nodes`: their number, then `tag x y z` each.
pub(super) fn nodes(cursor: &mut Cursor, assembly: &mut Assembly) -> Result<()> {
    let least = if cursor.is_binary() { 28 } else { 8 };
    let count = cursor.text_count("nodes", least)?;
    assembly.reserve_nodes(count);
    for _ in 0..count {
        cursor.begin_record();
        let tag = cursor.int_tag("the tag of a node")?;
        assembly.add_node(cursor, tag)?;
        let mut x = Vec3::ZERO;
        for d in 0..3 {
            x[d] = cursor.coordinate()?;
        }
        assembly.add_coordinates(x);
        cursor.end_record()?;
    }
    Ok(())
}

/// `$Elements`: their number, then in ASCII `tag type tags… nodes…` each; in binary runs of one
/// type, each with `type length tags` ahead of its elements.
pub(super) fn elements(cursor: &mut Cursor, assembly: &mut Assembly) -> Result<()> {
    let count = cursor.text_count("elements", 8)?;
    assembly.reserve_elements(count);
    if cursor.is_binary() {
        return runs(cursor, assembly, count);
    }
    for _ in 0..count {
        cursor.begin_record();
        let tag = cursor.int_tag("the tag of an element")?;
        let kind = cursor.int("the type of an element")?;
        let kind = ElementType::new(cursor, kind)?;
        let tags = cursor.count("tags of an element", 1, 4)?;
        element(cursor, assembly, kind, tags, tag)?;
        cursor.end_record()?;
    }
    Ok(())
}

fn runs(cursor: &mut Cursor, assembly: &mut Assembly, count: u64) -> Result<()> {
    let mut left = count;
    while left > 0 {
        let kind = cursor.int("the type of elements")?;
        let kind = ElementType::new(cursor, kind)?;
        let what = "the length of a run of elements";
        let length = cursor.int_tag(what)?;
        if length > left {
            let what = format!("{what}, {left} at most");
            return Err(cursor.unexpected(&what, &length.to_string()));
        }
        left -= length;
        let tags = cursor.int("the number of tags of an element")?;
        let Ok(tags) = u64::try_from(tags) else {
            return Err(cursor.unexpected("the number of tags of an element", &tags.to_string()));
        };
        let bytes = (1 + kind.nodes() + tags as usize).saturating_mul(4);
        cursor.check_room(length, "elements", bytes)?;
        for _ in 0..length {
            let tag = cursor.int_tag("the tag of an element")?;
            element(cursor, assembly, kind, tags, tag)?;
        }
    }
    Ok(())
}

/// The tags of an element, the first of which is its physical group (0: none), and its nodes.
fn element(
    cursor: &mut Cursor,
    assembly: &mut Assembly,
    kind: ElementType,
    tags: u64,
    tag: u64,
) -> Result<()> {
    let mut group = None;
    if tags > 0 {
        // A surface turned round has its group's tag with a minus sign.
        let number = cursor.int("the physical group of an element")?;
        group = Some(number.unsigned_abs()).filter(|&g| g > 0);
        cursor.skip(tags - 1, 4, "the tags of an element")?;
    }
    match kind {
        ElementType::Ignored { nodes } => cursor.skip(nodes as u64, 4, "the nodes of an element"),
        ElementType::Line => {
            let nodes = node_numbers(cursor, assembly, tag)?;
            assembly.add_line(nodes, group.as_slice());
            Ok(())
        }
        ElementType::Triangle => {
            let nodes = node_numbers(cursor, assembly, tag)?;
            assembly.add_triangle(nodes, group.as_slice());
            Ok(())
        }
        ElementType::Tetrahedron => {
            let nodes = node_numbers(cursor, assembly, tag)?;
            assembly.add_tetrahedron(tag, nodes, group);
            Ok(())
        }
    }
}

fn node_numbers<const N: usize>(
    cursor: &mut Cursor,
    assembly: &Assembly,
    element: u64,
) -> Result<[u32; N]> {
    let mut nodes = [0; N];
    for node in &mut nodes {
        let tag = cursor.int_tag("the tag of a node")?;
        *node = assembly.node_number(cursor, tag, element)?;
    }
    Ok(nodes)
}
