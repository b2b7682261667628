//! The sections of MSH 4.1: geometrical entities with their groups, then nodes and elements in
//! blocks, one an entity.

use super::super::GmshProblem;
use super::Result;
use super::assembly::Assembly;
use super::cursor::Cursor;
use super::element_type::ElementType;
use moldwarp::Vec3;
use std::collections::HashMap;

/// Tags of the physical groups of each curve, surface and volume, by dimension and tag.
pub(super) type EntityGroups = HashMap<(i64, i64), Vec<u64>>;

/// `$Entities`: how many points, curves, surfaces and volumes, then each with its place, its
/// physical groups and what bounds it.
pub(super) fn entities(cursor: &mut Cursor) -> Result<EntityGroups> {
    let what = ["points", "curves", "surfaces", "volumes"];
    let mut counts = [0; 4];
    cursor.begin_record();
    for dimension in 0..4 {
        // A point has a tag, three coordinates and the number of its groups; the others have a
        // box for the coordinates and the number of their bounds.
        let (fields, bytes) = if dimension == 0 { (5, 36) } else { (9, 68) };
        counts[dimension] = cursor.count(what[dimension], fields, bytes)?;
    }
    cursor.end_record()?;
    let mut groups = EntityGroups::new();
    for dimension in 0..4 {
        for _ in 0..counts[dimension] {
            cursor.begin_record();
            let tag = cursor.int("the tag of an entity")?;
            let place = if dimension == 0 { 3 } else { 6 };
            cursor.skip(place, 8, "the coordinates of an entity")?;
            let physical = physical_groups(cursor)?;
            if dimension > 0 {
                let bounds = cursor.count("bounding entities", 1, 4)?;
                cursor.skip(bounds, 4, "the bounds of an entity")?;
            }
            cursor.end_record()?;
            if dimension >= 1 && !physical.is_empty() {
                groups.insert((dimension as i64, tag), physical);
            }
        }
    }
    Ok(groups)
}

fn physical_groups(cursor: &mut Cursor) -> Result<Vec<u64>> {
    let count = cursor.count("physical groups", 1, 4)?;
    let mut groups = Vec::new();
    for _ in 0..count {
        // A surface turned round has its group's tag with a minus sign.
        let group = cursor.int("the tag of a physical group")?.unsigned_abs();
        if group > 0 {
            groups.push(group);
        }
    }
    groups.sort_unstable();
    groups.dedup();
    Ok(groups)
}

/// `blocks total smallest-tag largest-tag`, the first two of which are returned.
fn totals(cursor: &mut Cursor, what: &'static str, fields: usize) -> Result<(u64, u64)> {
    cursor.begin_record();
    let blocks = cursor.count("blocks", 4, 20)?;
    let total = cursor.count(what, fields, 8 * fields)?;
    cursor.skip(2, 8, "the smallest and largest tag")?;
    cursor.end_record()?;
    Ok((blocks, total))
}

/// Counts a block's things off those its section has left.
fn take(cursor: &Cursor, left: &mut u64, count: u64, what: &str) -> Result<()> {
    match left.checked_sub(count) {
        Some(rest) => {
            *left = rest;
            Ok(())
        }
        None => {
            let what = format!("{left} {what} or fewer, which the section has left");
            Err(cursor.unexpected(&what, &count.to_string()))
        }
    }
}

/// After the last block nothing may be left of what the section promised.
fn all_taken(cursor: &Cursor, left: u64, what: &'static str) -> Result<()> {
    match left {
        0 => Ok(()),
        _ => Err(cursor.wrong(GmshProblem::Expected {
            expected: format!("{left} more {what}, as the section's first line says"),
            found: "its last block at an end".to_owned(),
        })),
    }
}

/// `$Nodes`: blocks of `dimension entity parametric length`, then all tags, then all coordinates.
pub(super) fn nodes(cursor: &mut Cursor, assembly: &mut Assembly) -> Result<()> {
    let (blocks, mut left) = totals(cursor, "nodes", 4)?;
    assembly.reserve_nodes(left);
    for _ in 0..blocks {
        cursor.begin_record();
        let dimension = cursor.int("the dimension of an entity")?;
        if !(0..=3).contains(&dimension) {
            return Err(cursor.unexpected("a dimension from 0 to 3", &dimension.to_string()));
        }
        cursor.int("the tag of an entity")?;
        // Nodes may have parameters on their curve or surface after their coordinates.
        let parameters = match cursor.int("0 or 1, whether nodes have parameters")? {
            0 => 0,
            1 => dimension as u64,
            n => return Err(cursor.unexpected("0 or 1", &n.to_string())),
        };
        let count = cursor.count("nodes", 4, 32)?;
        take(cursor, &mut left, count, "nodes")?;
        cursor.end_record()?;
        for _ in 0..count {
            cursor.begin_record();
            let tag = cursor.size_tag("the tag of a node")?;
            assembly.add_node(cursor, tag)?;
        }
        for _ in 0..count {
            cursor.begin_record();
            let mut x = Vec3::ZERO;
            for d in 0..3 {
                x[d] = cursor.coordinate()?;
            }
            cursor.skip(parameters, 8, "the parameters of a node")?;
            cursor.end_record()?;
            assembly.add_coordinates(x);
        }
    }
    all_taken(cursor, left, "nodes")
}

/// `$Elements`: blocks of `dimension entity type length`, then `tag nodes…` each.
pub(super) fn elements(
    cursor: &mut Cursor,
    assembly: &mut Assembly,
    groups: &EntityGroups,
) -> Result<()> {
    let (blocks, mut left) = totals(cursor, "elements", 2)?;
    assembly.reserve_elements(left);
    for _ in 0..blocks {
        cursor.begin_record();
        let dimension = cursor.int("the dimension of an entity")?;
        let entity = cursor.int("the tag of an entity")?;
        let kind = cursor.int("the type of elements")?;
        let kind = ElementType::new(cursor, kind)?;
        let fields = 1 + kind.nodes();
        let count = cursor.count("elements", fields, 8 * fields)?;
        take(cursor, &mut left, count, "elements")?;
        cursor.end_record()?;
        let groups = groups.get(&(dimension, entity)).map_or(&[][..], |g| g);
        if let (ElementType::Tetrahedron, [first, second, ..]) = (kind, groups)
            && count > 0
        {
            cursor.begin_record();
            let element = cursor.size_tag("the tag of an element")?;
            return Err(cursor.wrong(assembly.two_volumes(element, *first, *second)));
        }
        for _ in 0..count {
            element(cursor, assembly, kind, groups)?;
        }
    }
    all_taken(cursor, left, "elements")
}

fn element(
    cursor: &mut Cursor,
    assembly: &mut Assembly,
    kind: ElementType,
    groups: &[u64],
) -> Result<()> {
    cursor.begin_record();
    let tag = cursor.size_tag("the tag of an element")?;
    match kind {
        ElementType::Ignored { nodes } => {
            cursor.skip(nodes as u64, 8, "the nodes of an element")?;
        }
        ElementType::Line => {
            let nodes = node_numbers(cursor, assembly, tag)?;
            assembly.add_line(nodes, groups);
        }
        ElementType::Triangle => {
            let nodes = node_numbers(cursor, assembly, tag)?;
            assembly.add_triangle(nodes, groups);
        }
        ElementType::Tetrahedron => {
            let nodes = node_numbers(cursor, assembly, tag)?;
            assembly.add_tetrahedron(tag, nodes, groups.first().copied());
        }
    }
    cursor.end_record()
}

fn node_numbers<const N: usize>(
    cursor: &mut Cursor,
    assembly: &Assembly,
    element: u64,
) -> Result<[u32; N]> {
    let mut nodes = [0; N];
    for node in &mut nodes {
        let tag = cursor.size_tag("the tag of a node")?;
        *node = assembly.node_number(cursor, tag, element)?;
    }
    Ok(nodes)
}
