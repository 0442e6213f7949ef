MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata none;
  CONST zonedata z7:=[FALSE,10,15,15,1,15,1];
  VAR speeddata bad:=[-1,2,3,4];
  PROC main()
    MoveL p1,v101,fine,tool0;
    MoveL p1,100,fine,tool0;
    MoveL p1,v100,z7,tool0;
    MoveL p1,v100,[FALSE,10,15,15,1,15,1],tool0;
    MoveL p1,[0,10,0,0],fine,tool0;
    MoveL p1,[10,20],fine,tool0;
    MoveL p1,v,z,tool0;
  ENDPROC
ENDMODULE
