MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveL p1,v100,z0,tool0;
    MoveL p1,v100,z1,tool0;
    MoveL p1,v100,Z200,tool0;
    MoveJ p1,v100,z50,tool0;
    MoveL p1,v100,fine,tool0;
  ENDPROC
ENDMODULE
