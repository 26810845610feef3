//! A check of what a picture's text must be; enough XML for what is written here.

/// Tags open and close in order, attributes are quoted, no stray markup or control character, one root.
pub(super) fn assert_well_formed(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    assert!(svg.starts_with("<svg ") && svg.contains("<title>"), "no title: {}", &svg[..svg.len().min(200)]);
    while let Some((text, tail)) = rest.split_once('<') {
        assert_text(text);
        let (tag, tail) = tail.split_once('>').expect("a tag without end");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else {
            let name = tag.split([' ', '/']).next().expect("a name");
            assert_eq!(tag.matches('"').count() % 2, 0, "quotes in <{tag}>");
            tag.split('"').for_each(assert_text);
            if !tag.ends_with('/') {
                open.push(name);
            }
        }
        rest = tail;
        assert!(!open.is_empty() || rest.trim().is_empty(), "text after the root");
    }
    assert!(open.is_empty(), "left open: {open:?}");
    assert!(!svg.contains("NaN") && !svg.contains("inf\""), "a number that is none");
}

fn assert_text(text: &str) {
    assert!(!text.contains('>') && !text.chars().any(|c| c.is_control() && c != '\n'), "stray markup: {text:?}");
    for entity in text.split('&').skip(1) {
        let name = entity.split(';').next();
        assert!(matches!(name, Some("lt" | "gt" | "amp" | "quot" | "apos")), "entity {name:?}");
    }
}
