//! Rows as a Parquet file.

use std::io::Write;
use std::sync::Arc;

use ::parquet::basic::{Compression, Repetition, Type as Physical};
use ::parquet::data_type::DoubleType;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::Type;
use anyhow::bail;

use super::Table;

/// Rows per group.
const GROUP: usize = 1 << 18;

/// A file being written, and the rows of its next group by columns.
pub(super) struct Parquet {
    writer: SerializedFileWriter<Box<dyn Write + Send>>,
    columns: Vec<Vec<f64>>,
}

impl Parquet {
    pub(super) fn new(out: Box<dyn Write + Send>, header: &[&str]) -> anyhow::Result<Self> {
        let field = |name: &&str| {
            let field =
                Type::primitive_type_builder(name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED);
            Ok(Arc::new(field.build()?))
        };
        let fields = header.iter().map(field).collect::<anyhow::Result<Vec<_>>>()?;
        let schema = Type::group_type_builder("lamina2d").with_fields(fields).build()?;
        let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
        let writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
        Ok(Self { writer, columns: vec![Vec::new(); header.len()] })
    }

    fn write_group(&mut self) -> anyhow::Result<()> {
        let mut group = self.writer.next_row_group()?;
        for column in &mut self.columns {
            let Some(mut writer) = group.next_column()? else { bail!("a column too many") };
            writer.typed::<DoubleType>().write_batch(column, None, None)?;
            writer.close()?;
            column.clear();
        }
        group.close()?;
        Ok(())
    }
}

impl Table for Parquet {
    fn row(&mut self, row: &[f64]) -> anyhow::Result<()> {
        self.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(*value));
        if self.columns[0].len() == GROUP { self.write_group() } else { Ok(()) }
    }
    fn end(mut self: Box<Self>) -> anyhow::Result<()> {
        if !self.columns[0].is_empty() {
            self.write_group()?;
        }
        self.writer.close()?;
        Ok(())
    }
}
