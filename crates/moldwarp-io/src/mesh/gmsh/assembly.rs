//! Nodes, elements and groups as they come out of a file, put together to a mesh.

use super::super::{GmshProblem, MeshFile};
use super::Result;
use super::cursor::Cursor;
use moldwarp::Vec3;
use moldwarp::mesh::{NONE, RawMesh};
use std::collections::{BTreeMap, HashMap, HashSet};

/// What has been read so far. Nodes and elements are numbered from 0 in the file's order.
#[derive(Default)]
pub(super) struct Assembly {
    numbers: Numbers,
    pub(super) node_tags: Vec<u64>,
    pub(super) nodes: Vec<Vec3>,
    pub(super) tets: Vec<[u32; 4]>,
    element_tags: Vec<u64>,
    /// The physical group of each tetrahedron.
    tet_groups: Vec<Option<u64>>,
    pub(super) triangles: BTreeMap<u64, Triangles>,
    pub(super) lines: BTreeMap<u64, Vec<[u32; 2]>>,
    names: BTreeMap<(i64, u64), String>,
    /// Whether the file lacks the section that says which groups elements are in.
    pub(super) no_entities: bool,
}

/// The triangles of a group; one that comes twice is kept once.
#[derive(Default)]
pub(super) struct Triangles {
    pub(super) list: Vec<[u32; 3]>,
    sorted: HashSet<[u32; 3]>,
}

/// The numbers of nodes by their tags. Tags may have gaps and be anything, but nearly always they are about as
/// large as there are nodes: then they are places in a list.
#[derive(Default)]
struct Numbers {
    /// [`NONE`] where there is no node.
    list: Vec<u32>,
    /// Of tags beyond the list.
    others: HashMap<u64, u32>,
}

impl Numbers {
    /// Makes room for so many before the first comes.
    fn reserve(&mut self, nodes: usize) {
        if self.list.is_empty() && self.others.is_empty() {
            self.list.resize(2 * nodes + 1, NONE);
        }
    }

    fn place(tag: u64) -> usize {
        usize::try_from(tag).unwrap_or(usize::MAX)
    }

    /// Whether the tag is a new one.
    fn insert(&mut self, tag: u64, number: u32) -> bool {
        match self.list.get_mut(Numbers::place(tag)) {
            Some(place) => std::mem::replace(place, number) == NONE,
            None => self.others.insert(tag, number).is_none(),
        }
    }

    #[inline]
    fn get(&self, tag: u64) -> Option<u32> {
        match self.list.get(Numbers::place(tag)) {
            Some(&number) => (number != NONE).then_some(number),
            None => self.others.get(&tag).copied(),
        }
    }
}

impl Assembly {
    /// Makes room; `count` must have been held against the length of the file.
    pub(super) fn reserve_nodes(&mut self, count: u64) {
        let count = count as usize;
        self.numbers.reserve(count);
        self.node_tags.reserve(count);
        self.nodes.reserve(count);
    }

    /// Makes room; `count` must have been held against the length of the file.
    pub(super) fn reserve_elements(&mut self, count: u64) {
        let count = count as usize;
        self.tets.reserve(count);
        self.element_tags.reserve(count);
        self.tet_groups.reserve(count);
    }

    /// A node by its tag, which was read last; its coordinates come in the same order.
    pub(super) fn add_node(&mut self, cursor: &Cursor, tag: u64) -> Result<()> {
        // A file with more nodes than 32 bits count would be over 100 GB.
        let number = self.node_tags.len() as u32;
        if !self.numbers.insert(tag, number) {
            return Err(cursor.wrong(GmshProblem::TwoNodes(tag)));
        }
        self.node_tags.push(tag);
        Ok(())
    }

    pub(super) fn add_coordinates(&mut self, x: Vec3) {
        self.nodes.push(x);
    }

    /// The number of the node whose tag was read last.
    #[inline]
    pub(super) fn node_number(&self, cursor: &Cursor, node: u64, element: u64) -> Result<u32> {
        match self.numbers.get(node) {
            Some(number) => Ok(number),
            None => Err(cursor.wrong(GmshProblem::NoSuchNode { element, node })),
        }
    }

    pub(super) fn add_triangle(&mut self, nodes: [u32; 3], groups: &[u64]) {
        let mut key = nodes;
        key.sort_unstable();
        for &group in groups {
            let triangles = self.triangles.entry(group).or_default();
            if triangles.sorted.insert(key) {
                triangles.list.push(nodes);
            }
        }
    }

    pub(super) fn add_line(&mut self, nodes: [u32; 2], groups: &[u64]) {
        for &group in groups {
            self.lines.entry(group).or_default().push(nodes);
        }
    }

    pub(super) fn add_tetrahedron(&mut self, tag: u64, nodes: [u32; 4], group: Option<u64>) {
        self.tets.push(nodes);
        self.element_tags.push(tag);
        self.tet_groups.push(group);
    }

    /// Names a group, on the line that was read last.
    pub(super) fn name_group(
        &mut self,
        cursor: &Cursor,
        (dimension, tag): (i64, u64),
        name: &str,
    ) -> Result<()> {
        match self.names.insert((dimension, tag), name.to_owned()) {
            Some(first) if first != name => Err(cursor.wrong(GmshProblem::TwoNamesOfOne {
                dimension,
                tag,
                first,
                second: name.to_owned(),
            })),
            _ => Ok(()),
        }
    }

    pub(super) fn group_name(&self, dimension: i64, tag: u64) -> String {
        match self.names.get(&(dimension, tag)) {
            Some(name) => name.clone(),
            None => tag.to_string(),
        }
    }

    pub(super) fn two_volumes(&self, element: u64, first: u64, second: u64) -> GmshProblem {
        GmshProblem::TwoVolumes {
            element,
            first: self.group_name(3, first),
            second: self.group_name(3, second),
        }
    }

    /// The mesh; `command` is what makes one in three dimensions.
    pub(super) fn finish(mut self, command: String) -> std::result::Result<MeshFile, GmshProblem> {
        if self.tets.is_empty() {
            return Err(GmshProblem::NoTetrahedra { command });
        }
        self.check_same_nodes()?;
        self.check_same_tags()?;
        let mut notes = Vec::new();
        self.drop_unused_nodes(&mut notes);
        let mut members: BTreeMap<u64, Vec<u32>> = BTreeMap::new();
        for (e, group) in self.tet_groups.iter().enumerate() {
            if let Some(group) = *group {
                members.entry(group).or_default().push(e as u32);
            }
        }
        self.check_names(3, "volume", members.keys())?;
        self.check_names(2, "surface", self.triangles.keys())?;
        self.note_empty_groups(&members, &mut notes);
        let triangles = std::mem::take(&mut self.triangles);
        let volume_groups = members
            .into_iter()
            .map(|(tag, members)| (self.group_name(3, tag), members))
            .collect();
        let surface_groups = triangles
            .into_iter()
            .map(|(tag, triangles)| (self.group_name(2, tag), triangles.list))
            .collect();
        Ok(MeshFile {
            raw: RawMesh {
                nodes: self.nodes,
                tets: self.tets,
                volume_groups,
                surface_groups,
            },
            node_tags: self.node_tags,
            element_tags: self.element_tags,
            notes,
        })
    }

    /// A named group without elements is left out, since nothing could be done with it.
    fn note_empty_groups(&self, volumes: &BTreeMap<u64, Vec<u32>>, notes: &mut Vec<String>) {
        let named = self.names.keys().any(|&(dimension, _)| dimension >= 2);
        if named && volumes.is_empty() && self.triangles.is_empty() {
            let why = match self.no_entities {
                true => "its section `$Entities`, which says what is in them, is missing",
                false => "MSH 2.2 loses them under Mesh.SaveAll, MSH 4.1 does not",
            };
            notes.push(format!(
                "no element is in one of the file's physical groups; {why}"
            ));
            return;
        }
        for (&(dimension, tag), name) in &self.names {
            let (kind, element, empty) = match dimension {
                3 => ("volume", "tetrahedron", !volumes.contains_key(&tag)),
                2 => ("surface", "triangle", !self.triangles.contains_key(&tag)),
                _ => continue,
            };
            if empty {
                notes.push(format!(
                    "physical {kind} `{name}` has no {element} in the file"
                ));
            }
        }
    }

    /// A tetrahedron in two volume groups stands twice in a file of MSH 2.2, under two tags.
    fn check_same_nodes(&self) -> std::result::Result<(), GmshProblem> {
        let mut sorted: Vec<([u32; 4], u32)> = (0..)
            .zip(&self.tets)
            .map(|(e, &tet)| {
                let mut key = tet;
                key.sort_unstable();
                (key, e)
            })
            .collect();
        sorted.sort_unstable();
        // The first in the file is the one to name.
        let twice = sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        let Some((a, b)) = twice.map(|p| (p[0].1 as usize, p[1].1 as usize)).min() else {
            return Ok(());
        };
        let [first, second] = [a, b].map(|e| self.element_tags[e]);
        Err(match (self.tet_groups[a], self.tet_groups[b]) {
            (Some(g), Some(h)) if g != h => self.two_volumes(first, g, h),
            _ => GmshProblem::SameTetrahedron { first, second },
        })
    }

    fn check_same_tags(&self) -> std::result::Result<(), GmshProblem> {
        if self.element_tags.is_sorted_by(|a, b| a < b) {
            return Ok(());
        }
        let mut sorted = self.element_tags.clone();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(GmshProblem::TwoElements(pair[0])),
            None => Ok(()),
        }
    }

    /// Two groups of one name could not be told apart by it.
    pub(super) fn check_names<'a>(
        &self,
        dimension: i64,
        kind: &'static str,
        tags: impl Iterator<Item = &'a u64>,
    ) -> std::result::Result<(), GmshProblem> {
        let mut seen = BTreeMap::new();
        for &tag in tags {
            let name = self.group_name(dimension, tag);
            if let Some(first) = seen.insert(name.clone(), tag) {
                return Err(GmshProblem::TwoNames {
                    kind,
                    first,
                    second: tag,
                    name,
                });
            }
        }
        Ok(())
    }

    /// Keeps the nodes of tetrahedra, and those of triangles in a group: should such a triangle
    /// be no face of a tetrahedron, it is for the mesh to say so.
    pub(super) fn drop_unused_nodes(&mut self, notes: &mut Vec<String>) {
        let mut used = vec![false; self.nodes.len()];
        let groups = self.triangles.values().flat_map(|t| &t.list);
        for &n in self.tets.iter().flatten().chain(groups.flatten()) {
            used[n as usize] = true;
        }
        if self.tets.is_empty() {
            let lines = self.lines.values().flatten().flatten();
            lines.for_each(|&n| used[n as usize] = true);
        }
        let dropped = used.iter().filter(|&&u| !u).count();
        if dropped == 0 {
            return;
        }
        let element = match self.tets.is_empty() {
            true => "triangle",
            false => "tetrahedron",
        };
        notes.push(match dropped {
            1 => format!("1 node belongs to no {element} and was dropped"),
            n => format!("{n} nodes belong to no {element} and were dropped"),
        });
        let mut renumbered = vec![0; used.len()];
        let kept = renumbered.iter_mut().zip(&used).filter(|(_, used)| **used);
        for (next, (number, _)) in kept.enumerate() {
            *number = next as u32;
        }
        let mut keep = used.iter();
        self.nodes.retain(|_| keep.next() == Some(&true));
        let mut keep = used.iter();
        self.node_tags.retain(|_| keep.next() == Some(&true));
        let lists = self.triangles.values_mut().flat_map(|t| &mut t.list);
        let lines = self.lines.values_mut().flatten().flatten();
        let all = self.tets.iter_mut().flatten().chain(lists.flatten());
        for n in all.chain(lines) {
            *n = renumbered[*n as usize];
        }
    }
}
